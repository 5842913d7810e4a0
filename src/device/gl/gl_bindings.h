// SPDX-License-Identifier: MIT
// The part of OpenGL's global state that running kernels changes: the program and the buffer binding points. Between
// begin and end it belongs to Talus, binding again what is bound already costs nothing, and in the caller's context all
// is as it was afterwards.
#pragma once

#include <array>

#include <epoxy/gl.h>

#include "device/gl/gl_program.h"

namespace talus::engine {

class GlBindings {
public:
    /// Does nothing if begun already. `restore`: whether `end` puts back what is bound now.
    void begin(bool restore);
    void end();

    void use_program(GLuint);
    void bind_storage(GLuint binding, const GlRange&);
    void bind_parameters(GLuint buffer);
    void bind_dispatches(GLuint buffer);
    /// To be called when a buffer was deleted: its name may come back for another one.
    void forget();

private:
    struct Range {
        GLuint buffer = 0;
        GLint64 offset = 0;
        GLint64 size = 0; // 0: the whole buffer
    };
    static Range saved_range(GLenum buffer, GLenum start, GLenum size, GLuint index);
    static void restore_range(GLenum target, GLuint index, const Range&);

    bool begun_ = false;
    bool restore_ = false;

    // what is bound as far as is known, 0 for "not known"
    GLuint program_ = 0;
    std::array<GlRange, k_max_storage_blocks> storage_{};
    GLuint parameters_ = 0;
    GLuint dispatches_ = 0;

    // the caller's
    GLint callers_program_ = 0;
    GLint callers_dispatches_ = 0;
    GLint callers_storage_ = 0;
    GLint callers_uniform_ = 0;
    std::array<Range, k_max_storage_blocks> callers_storage_ranges_{};
    Range callers_parameters_;
};

} // namespace talus::engine
