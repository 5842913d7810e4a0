// SPDX-License-Identifier: MIT
// See gl_objects.h.
#include "device/gl/gl_objects.h"

#include <utility>

#include <talus/types.h>

namespace talus::engine {

GlBuffer::GlBuffer(const std::string& label_text, std::size_t bytes, GLbitfield flags) : size_(bytes) {
    // Errors of earlier calls, perhaps the caller's own, are not to be taken for this one's.
    for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i) {
    }
    glCreateBuffers(1, &name_);
    glNamedBufferStorage(name_, static_cast<GLsizeiptr>(bytes), nullptr, flags);
    bool made = glGetError() == GL_NO_ERROR;
    if (made && (flags & GL_MAP_PERSISTENT_BIT) != 0) {
        mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(name_, 0, static_cast<GLsizeiptr>(bytes), flags));
        made = mapped_ != nullptr;
    }
    if (!made) {
        glDeleteBuffers(1, &name_);
        throw Error("the GPU has no room for the buffer " + label_text + " (" + std::to_string(bytes) + " bytes)");
    }
    label(label_text);
}

GlBuffer::~GlBuffer() {
    if (name_ != 0) glDeleteBuffers(1, &name_); // unmaps too
}

GlBuffer::GlBuffer(GlBuffer&& other) noexcept
    : name_(std::exchange(other.name_, 0)), size_(std::exchange(other.size_, 0)),
      mapped_(std::exchange(other.mapped_, nullptr)) {}

GlBuffer& GlBuffer::operator=(GlBuffer&& other) noexcept {
    std::swap(name_, other.name_);
    std::swap(size_, other.size_);
    std::swap(mapped_, other.mapped_);
    return *this;
}

void GlBuffer::label(const std::string& text) const {
    glObjectLabel(GL_BUFFER, name_, -1, text.c_str());
}

GlFence GlFence::place() {
    GlFence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    return fence;
}

GlFence::~GlFence() {
    if (sync_ != nullptr) glDeleteSync(sync_);
}

GlFence::GlFence(GlFence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}

GlFence& GlFence::operator=(GlFence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
}

bool GlFence::passed() {
    return poll(0, 0);
}

void GlFence::wait() {
    constexpr GLuint64 k_second = 1'000'000'000;
    while (!poll(GL_SYNC_FLUSH_COMMANDS_BIT, k_second)) {
    }
}

bool GlFence::poll(GLbitfield flags, GLuint64 nanoseconds) {
    if (sync_ == nullptr) return true;
    const GLenum result = glClientWaitSync(sync_, flags, nanoseconds);
    if (result == GL_WAIT_FAILED)
        throw Error("the OpenGL driver cannot say when the GPU is done: its context was lost or reset");
    if (result == GL_TIMEOUT_EXPIRED) return false;
    glDeleteSync(std::exchange(sync_, nullptr));
    return true;
}

} // namespace talus::engine
