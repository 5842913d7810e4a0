// SPDX-License-Identifier: MIT
// An OpenGL 4.5 context without a window, as a renderer on a server makes one: through EGL, on the first device that
// has one. A program with a window has its context from GLFW, SDL or Qt instead.
#pragma once

#include <array>
#include <stdexcept>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

class HeadlessContext {
public:
    /// Shares its objects (buffers, programs, fences) with another context where one is given.
    explicit HeadlessContext(const HeadlessContext* shared = nullptr) {
        for (const EGLDisplay candidate : shared != nullptr ? std::vector{shared->display} : displays()) {
            if (eglInitialize(candidate, nullptr, nullptr) == EGL_FALSE) continue;
            constexpr std::array<EGLint, 3> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
            constexpr std::array<EGLint, 5> version{EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                                                    EGL_NONE};
            EGLConfig config = nullptr;
            EGLint count = 0;
            eglBindAPI(EGL_OPENGL_API);
            eglChooseConfig(candidate, wanted.data(), &config, 1, &count);
            context = eglCreateContext(candidate, config, shared != nullptr ? shared->context : EGL_NO_CONTEXT,
                                       version.data());
            display = candidate;
            if (context != EGL_NO_CONTEXT) return;
        }
        throw std::runtime_error("EGL has no OpenGL 4.5 context");
    }
    ~HeadlessContext() {
        if (eglGetCurrentContext() == context) eglMakeCurrent(display, nullptr, nullptr, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
    }
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    /// On the calling thread; a context is current on one thread at most.
    void make_current() const {
        eglBindAPI(EGL_OPENGL_API);
        if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
            throw std::runtime_error("EGL does not make the context current");
    }

private:
    static std::vector<EGLDisplay> displays() {
        std::array<EGLDeviceEXT, 8> devices{};
        EGLint count = 0;
        eglQueryDevicesEXT(devices.size(), devices.data(), &count);
        std::vector<EGLDisplay> result;
        for (EGLint i = 0; i < count; ++i)
            result.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices.at(i), nullptr));
        return result;
    }

    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
};
