// SPDX-License-Identifier: MIT
// A screen of its own (Xvfb), a program's window on it, and a user who types, points, drags and looks (XTest).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "render/picture.h"

namespace talus::tests {

class XWindow {
public:
    /// Starts a screen, and on it the program in a folder; waits for its window. Throws std::runtime_error, with what
    /// the program said, where that does not come. `dots_per_inch`: 96 of a usual screen.
    XWindow(const std::vector<std::string>& command, const std::filesystem::path& folder, int dots_per_inch = 96);
    ~XWindow();
    XWindow(const XWindow&) = delete;
    XWindow& operator=(const XWindow&) = delete;

    /// Whether there is a program to make a screen with.
    static bool is_possible();

    std::string title() const;
    /// Waits until the title is as wanted; false where that takes more than `seconds`.
    bool wait_for_title(const std::function<bool(const std::string&)>& wanted, double seconds = 20.0) const;
    /// The program's exit status, once it has ended; -1 where it runs on after `seconds`.
    int wait_for_end(double seconds = 20.0);

    /// By their X names: "space", "period", "F1", "Right". Modifiers stand before: "Control_L+q".
    void press(const std::string& keys) const;
    void hold(const std::string& key, bool down) const;
    void move_mouse(int x, int y) const;
    void hold_button(int button, bool down) const; ///< 1 left, 2 middle, 3 right
    void click(int x, int y) const;
    void turn_wheel(int notches) const;
    /// As a file manager does: asks the window to take a file over from it (Xdnd).
    void drop_file(const std::filesystem::path&) const;

    /// All of the window.
    render::Picture look() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace talus::tests
