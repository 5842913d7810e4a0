// SPDX-License-Identifier: MIT
// The window and its OpenGL context; what the user does in it arrives as calls on an InputHandler.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

struct GLFWwindow;

namespace talus::viewer {

enum class MouseButton { Left, Right, Middle };

/// Keys are those of GLFW (GLFW_KEY_...), by what they mean on a US keyboard. Positions are in pixels of the
/// framebuffer, from the upper left corner.
class InputHandler {
public:
    virtual ~InputHandler() = default;
    virtual void key_pressed(int key, bool shift, bool control, bool repeated) = 0;
    virtual void mouse_pressed(MouseButton, bool shift) = 0;
    virtual void mouse_released(MouseButton) = 0;
    virtual void mouse_moved(glm::vec2 position, glm::vec2 movement) = 0;
    virtual void wheel_turned(float notches) = 0;
    virtual void files_dropped(const std::vector<std::filesystem::path>&) = 0;
};

class Window {
public:
    /// Opens a window with an OpenGL 4.5 core context, which is current from then on. Throws Error where there is no
    /// screen, or no such context; the message names the ways that need no window.
    Window(std::uint32_t width, std::uint32_t height, InputHandler&);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    GLFWwindow* handle() const noexcept { return window; }
    bool should_close() const;
    void close();
    /// Pixels; 0 while the window is an icon.
    glm::uvec2 framebuffer_size() const;
    /// Pixels for one unit in which a usual screen is measured: 2 on a HiDPI screen.
    float content_scale() const;
    bool is_key_down(int key) const;
    glm::vec2 mouse_position() const;
    void set_title(const std::string&);
    void toggle_full_screen();
    /// Shows what was drawn; waits for the screen's next refresh where the system offers that.
    void swap();

    /// Frames a second that the screen shows.
    double refresh_rate() const;

private:
    struct Callbacks;

    glm::vec2 to_pixels(double x, double y) const;

    InputHandler& handler;
    GLFWwindow* window = nullptr;
    glm::vec2 last_mouse{0.0f};
    std::string title;
    int placed_x = 0, placed_y = 0, placed_width = 0, placed_height = 0; ///< before the full screen
};

} // namespace talus::viewer
