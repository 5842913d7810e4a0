// SPDX-License-Identifier: MIT
// What the caller has current on its thread while Talus works in a context of its own.
#pragma once

namespace talus::engine {

/// Puts back, at the end of its life, what EGL had current on this thread at the start: a context with its surfaces, or
/// none, so that another thread can go on with the context that was used meanwhile. Costs little where nothing changed.
class CallersContext {
public:
    /// Does nothing unless `wanted`, or where there is no EGL.
    explicit CallersContext(bool wanted = true);
    ~CallersContext();
    CallersContext(const CallersContext&) = delete;
    CallersContext& operator=(const CallersContext&) = delete;

private:
    bool active_;
    unsigned api_ = 0; // the EGL types, spelt out: EGL's header brings those of X11 with their macros
    void* display_ = nullptr;
    void* context_ = nullptr;
    void* draw_ = nullptr;
    void* read_ = nullptr;
};

} // namespace talus::engine
