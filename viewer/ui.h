// SPDX-License-Identifier: MIT
// Dear ImGui in a window: set up, begun and ended once a frame, in letters that fit the screen.
#pragma once

#include "viewer/window.h"

namespace talus::viewer {

class Ui {
public:
    explicit Ui(Window&);
    ~Ui();
    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;

    /// Panels are described between these two.
    void begin();
    /// Draws them into the window's framebuffer.
    void end();

    /// Whether the mouse is on a panel, or a text is being typed: then they are not for the scene.
    bool wants_mouse() const;
    bool wants_keyboard() const;

private:
    void fit_letters(float scale);

    Window& window;
    float fitted_scale = 0.0f;
};

} // namespace talus::viewer
