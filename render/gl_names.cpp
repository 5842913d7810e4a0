// SPDX-License-Identifier: MIT
// See gl_names.h.
#include "render/gl_names.h"

#include <algorithm>

namespace talus::render {

Buffer make_buffer() {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    return Buffer(name);
}

Texture make_texture(GLenum target) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    return Texture(name);
}

Framebuffer make_framebuffer() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return Framebuffer(name);
}

Renderbuffer make_renderbuffer() {
    GLuint name = 0;
    glCreateRenderbuffers(1, &name);
    return Renderbuffer(name);
}

VertexArray make_vertex_array() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return VertexArray(name);
}

void UploadBuffer::upload(std::span<const std::byte> bytes) {
    if (buffer == 0) buffer = make_buffer();
    if (capacity < bytes.size() || capacity == 0) {
        // Never empty: shaders may have the buffer bound without a read from it.
        capacity = std::max<std::size_t>(64, bytes.size() + bytes.size() / 2);
    }
    // New storage each time, so that the driver need not wait for pictures which still read the old one.
    glNamedBufferData(buffer, static_cast<GLsizeiptr>(capacity), nullptr, GL_STREAM_DRAW);
    if (!bytes.empty()) glNamedBufferSubData(buffer, 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

} // namespace talus::render
