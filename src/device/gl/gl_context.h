// SPDX-License-Identifier: MIT
// The OpenGL context that a device runs in: one of its own, headless through EGL, or the caller's.
#pragma once

#include <memory>
#include <string>

#include <talus/world.h>

namespace talus::engine {

class OpenGlContext {
public:
    /// A context of its own without a window: the first OpenGL 4.5 renderer in hardware, or else the first in software.
    /// The context that was current on the thread stays current. A debug context, which TALUS_GL_DEBUG=1 asks for too,
    /// sends the driver's messages to the log. Throws Error with all that was tried.
    static std::unique_ptr<OpenGlContext> own(bool debug = false);
    /// The one that is current on this thread. Throws Error if there is none, or it is not desktop OpenGL 4.5.
    static std::unique_ptr<OpenGlContext> current();

    ~OpenGlContext();
    OpenGlContext(const OpenGlContext&) = delete;
    OpenGlContext& operator=(const OpenGlContext&) = delete;

    /// Makes an own context current on this thread; of the caller's context, checks that it is. Cheap where it is
    /// current already. Throws Error where it cannot be had.
    void make_current();

    bool is_own() const noexcept { return own_; }
    /// Whether it is a debug context of our own.
    bool is_debug() const noexcept { return debug_; }
    bool is_software() const noexcept;
    const std::string& renderer() const noexcept { return renderer_; }
    DeviceInfo info() const;

    /// What the device is doing, for debug messages.
    const char* activity = "set-up";

private:
    friend struct EglCandidate;
    OpenGlContext() = default;
    void describe();

    void* (*query_current_)() = nullptr; // how the handle of the current context is asked for: EGL or GLX
    void* context_ = nullptr;
    void* display_ = nullptr;
    void* surface_ = nullptr;
    bool own_ = false;
    bool debug_ = false;
    std::string renderer_;
    std::string driver_;
    std::string why_;
};

} // namespace talus::engine
