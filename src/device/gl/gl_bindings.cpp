// SPDX-License-Identifier: MIT
// See gl_bindings.h.
#include "device/gl/gl_bindings.h"

namespace talus::engine {
namespace {

/// The caller's binding, or none where its buffer was one of ours that has been replaced meanwhile.
GLuint if_alive(GLuint buffer) {
    return buffer != 0 && glIsBuffer(buffer) == GL_TRUE ? buffer : 0;
}

} // namespace

void GlBindings::begin(bool restore) {
    if (begun_) return;
    begun_ = true;
    restore_ = restore;
    forget();
    if (!restore) return;
    glGetIntegerv(GL_CURRENT_PROGRAM, &callers_program_);
    glGetIntegerv(GL_DISPATCH_INDIRECT_BUFFER_BINDING, &callers_dispatches_);
    glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &callers_storage_);
    glGetIntegerv(GL_UNIFORM_BUFFER_BINDING, &callers_uniform_);
    for (GLuint i = 0; i < k_max_storage_blocks; ++i)
        callers_storage_ranges_[i] = saved_range(GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                                                 GL_SHADER_STORAGE_BUFFER_SIZE, i);
    callers_parameters_ =
        saved_range(GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE, k_parameters_binding);
}

void GlBindings::end() {
    if (!begun_) return;
    begun_ = false;
    if (!restore_) return;
    glUseProgram(static_cast<GLuint>(callers_program_));
    for (GLuint i = 0; i < k_max_storage_blocks; ++i)
        restore_range(GL_SHADER_STORAGE_BUFFER, i, callers_storage_ranges_[i]);
    restore_range(GL_UNIFORM_BUFFER, k_parameters_binding, callers_parameters_);
    // Last, because binding to an indexed point binds to the general one too.
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, if_alive(static_cast<GLuint>(callers_storage_)));
    glBindBuffer(GL_UNIFORM_BUFFER, if_alive(static_cast<GLuint>(callers_uniform_)));
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, if_alive(static_cast<GLuint>(callers_dispatches_)));
}

void GlBindings::use_program(GLuint program) {
    if (program_ != program) glUseProgram(program);
    program_ = program;
}

void GlBindings::bind_storage(GLuint binding, const GlRange& range) {
    if (storage_[binding] != range)
        glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, range.buffer, static_cast<GLintptr>(range.offset),
                          static_cast<GLsizeiptr>(range.size));
    storage_[binding] = range;
}

void GlBindings::bind_parameters(GLuint buffer) {
    if (parameters_ != buffer) glBindBufferBase(GL_UNIFORM_BUFFER, k_parameters_binding, buffer);
    parameters_ = buffer;
}

void GlBindings::bind_dispatches(GLuint buffer) {
    if (dispatches_ != buffer) glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer);
    dispatches_ = buffer;
}

void GlBindings::forget() {
    program_ = 0;
    storage_.fill({});
    parameters_ = 0;
    dispatches_ = 0;
}

GlBindings::Range GlBindings::saved_range(GLenum buffer, GLenum start, GLenum size, GLuint index) {
    Range range;
    GLint name = 0;
    glGetIntegeri_v(buffer, index, &name);
    range.buffer = static_cast<GLuint>(name);
    glGetInteger64i_v(start, index, &range.offset);
    glGetInteger64i_v(size, index, &range.size);
    return range;
}

void GlBindings::restore_range(GLenum target, GLuint index, const Range& range) {
    const GLuint buffer = if_alive(range.buffer);
    if (buffer == 0 || range.size == 0)
        glBindBufferBase(target, index, buffer);
    else
        glBindBufferRange(target, index, buffer, static_cast<GLintptr>(range.offset),
                          static_cast<GLsizeiptr>(range.size));
}

} // namespace talus::engine
