// SPDX-License-Identifier: MIT
// GLFW measures windows and the mouse in screen coordinates, which may be coarser than pixels; all that leaves this
// file is in pixels.
#include "viewer/window.h"

#include <algorithm>

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <talus/types.h>

namespace talus::viewer {

namespace {

[[noreturn]] void refuse(const std::string& what) {
    const char* description = nullptr;
    glfwGetError(&description);
    throw Error("view: " + what + (description != nullptr ? std::string(" (") + description + ")" : "") +
                ". Without a window, `talus run SCENE --video FILE.mp4` or `--image FILE.png` shows a scene.");
}

Window& window_of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
}

} // namespace

struct Window::Callbacks {
    static void key(GLFWwindow* window, int key, int, int action, int modifiers) {
        if (action == GLFW_RELEASE) return;
        window_of(window).handler.key_pressed(key, (modifiers & GLFW_MOD_SHIFT) != 0,
                                              (modifiers & GLFW_MOD_CONTROL) != 0, action == GLFW_REPEAT);
    }

    static void mouse_button(GLFWwindow* window, int button, int action, int modifiers) {
        if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
        const MouseButton which = button == GLFW_MOUSE_BUTTON_LEFT    ? MouseButton::Left
                                  : button == GLFW_MOUSE_BUTTON_RIGHT ? MouseButton::Right
                                                                      : MouseButton::Middle;
        InputHandler& handler = window_of(window).handler;
        if (action == GLFW_PRESS)
            handler.mouse_pressed(which, (modifiers & GLFW_MOD_SHIFT) != 0);
        else
            handler.mouse_released(which);
    }

    static void mouse(GLFWwindow* window, double x, double y) {
        Window& self = window_of(window);
        const glm::vec2 position = self.to_pixels(x, y);
        const glm::vec2 movement = position - self.last_mouse;
        self.last_mouse = position;
        self.handler.mouse_moved(position, movement);
    }

    static void wheel(GLFWwindow* window, double, double notches) {
        window_of(window).handler.wheel_turned(static_cast<float>(notches));
    }

    static void drop(GLFWwindow* window, int count, const char** names) {
        window_of(window).handler.files_dropped({names, names + count});
    }
};

Window::Window(std::uint32_t width, std::uint32_t height, InputHandler& input) : handler(input), title("Talus") {
    if (glfwInit() == GLFW_FALSE) refuse("no window can be opened");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0); // pictures are drawn elsewhere, and only shown here
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "talus");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "talus");
    window = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title.c_str(), nullptr, nullptr);
    if (window == nullptr) {
        try {
            refuse("no window with OpenGL 4.5 can be opened");
        } catch (...) {
            glfwTerminate();
            throw;
        }
    }
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window, this);
    glfwSetKeyCallback(window, Callbacks::key);
    glfwSetMouseButtonCallback(window, Callbacks::mouse_button);
    glfwSetCursorPosCallback(window, Callbacks::mouse);
    glfwSetScrollCallback(window, Callbacks::wheel);
    glfwSetDropCallback(window, Callbacks::drop);
    last_mouse = mouse_position();
}

Window::~Window() {
    glfwDestroyWindow(window);
    glfwTerminate();
}

bool Window::should_close() const {
    return glfwWindowShouldClose(window) != GLFW_FALSE;
}

void Window::close() {
    glfwSetWindowShouldClose(window, GLFW_TRUE);
}

glm::uvec2 Window::framebuffer_size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return {std::max(width, 0), std::max(height, 0)};
}

float Window::content_scale() const {
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window, &x, &y);
    return std::max(x, y);
}

bool Window::is_key_down(int key) const {
    return glfwGetKey(window, key) == GLFW_PRESS;
}

glm::vec2 Window::mouse_position() const {
    double x = 0.0, y = 0.0;
    glfwGetCursorPos(window, &x, &y);
    return to_pixels(x, y);
}

glm::vec2 Window::to_pixels(double x, double y) const {
    int width = 0, height = 0;
    glfwGetWindowSize(window, &width, &height);
    const glm::uvec2 pixels = framebuffer_size();
    return {x * pixels.x / std::max(width, 1), y * pixels.y / std::max(height, 1)};
}

void Window::set_title(const std::string& wanted) {
    if (wanted == title) return;
    title = wanted;
    glfwSetWindowTitle(window, title.c_str());
}

void Window::toggle_full_screen() {
    if (glfwGetWindowMonitor(window) != nullptr) {
        glfwSetWindowMonitor(window, nullptr, placed_x, placed_y, placed_width, placed_height, GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    if (mode == nullptr) return;
    glfwGetWindowPos(window, &placed_x, &placed_y);
    glfwGetWindowSize(window, &placed_width, &placed_height);
    glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::swap() {
    glfwSwapBuffers(window);
}

double Window::refresh_rate() const {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
    return mode != nullptr && mode->refreshRate > 0 ? mode->refreshRate : 60.0;
}

} // namespace talus::viewer
