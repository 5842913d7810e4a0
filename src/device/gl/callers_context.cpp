// SPDX-License-Identifier: MIT
// See callers_context.h.
#include "device/gl/callers_context.h"

#include <epoxy/egl.h>

namespace talus::engine {

CallersContext::CallersContext(bool wanted) : active_(wanted && epoxy_has_egl()) {
    if (!active_) return;
    api_ = eglQueryAPI();
    context_ = eglGetCurrentContext();
    if (context_ == EGL_NO_CONTEXT) return;
    display_ = eglGetCurrentDisplay();
    draw_ = eglGetCurrentSurface(EGL_DRAW);
    read_ = eglGetCurrentSurface(EGL_READ);
}

CallersContext::~CallersContext() {
    if (!active_) return;
    if (eglGetCurrentContext() != context_) {
        if (context_ != EGL_NO_CONTEXT)
            eglMakeCurrent(display_, draw_, read_, context_);
        else
            eglMakeCurrent(eglGetCurrentDisplay(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    if (eglQueryAPI() != api_) eglBindAPI(api_);
}

} // namespace talus::engine
