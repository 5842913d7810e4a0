// SPDX-License-Identifier: MIT
// Dear ImGui in a window: set up, begun and ended once a frame, in letters that fit the screen.
#pragma once

#include <vector>

#include "viewer/window.h"

namespace talus::viewer {

class Ui {
public:
    explicit Ui(Window&);
    ~Ui();
    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;

    /// To be called for each key that goes down, so that panels see also one that was up again before the frame began.
    void note_key(int key) { pressed.push_back(key); }

    /// Panels are described between these two.
    void begin();
    /// Draws them into the window's framebuffer.
    void end();

    /// Whether the mouse is on a panel, or a text is being typed: then they are not for the scene.
    bool wants_mouse() const;
    bool wants_keyboard() const;

private:
    void fit_letters(float scale);
    void hold_keys(bool for_frame);

    Window& window;
    float fitted_scale = 0.0f;
    std::vector<int> pressed; ///< since the last frame
};

} // namespace talus::viewer
