// SPDX-License-Identifier: MIT
// Owners of OpenGL names.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

namespace talus::render {

/// Owns a name. The context that it belongs to must be current when it goes.
template <void (*destroy)(GLuint)> class GlName {
public:
    GlName() = default;
    explicit GlName(GLuint created) : name(created) {}
    ~GlName() {
        if (name != 0) destroy(name);
    }
    GlName(GlName&& other) noexcept : name(std::exchange(other.name, 0)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name, other.name);
        return *this;
    }
    operator GLuint() const noexcept { return name; }

private:
    GLuint name = 0;
};

namespace detail {
inline void destroy_buffer(GLuint name) {
    glDeleteBuffers(1, &name);
}
inline void destroy_texture(GLuint name) {
    glDeleteTextures(1, &name);
}
inline void destroy_framebuffer(GLuint name) {
    glDeleteFramebuffers(1, &name);
}
inline void destroy_renderbuffer(GLuint name) {
    glDeleteRenderbuffers(1, &name);
}
inline void destroy_vertex_array(GLuint name) {
    glDeleteVertexArrays(1, &name);
}
inline void destroy_program(GLuint name) {
    glDeleteProgram(name);
}
} // namespace detail

using Buffer = GlName<detail::destroy_buffer>;
using Texture = GlName<detail::destroy_texture>;
using Framebuffer = GlName<detail::destroy_framebuffer>;
using Renderbuffer = GlName<detail::destroy_renderbuffer>;
using VertexArray = GlName<detail::destroy_vertex_array>;
using Program = GlName<detail::destroy_program>;

Buffer make_buffer();
Texture make_texture(GLenum target);
Framebuffer make_framebuffer();
Renderbuffer make_renderbuffer();
VertexArray make_vertex_array();

/// A buffer that the host fills anew now and then; it is made larger as needed.
class UploadBuffer {
public:
    void upload(std::span<const std::byte>);
    template <typename T> void upload(const std::vector<T>& values) { upload(std::as_bytes(std::span(values))); }
    operator GLuint() const noexcept { return buffer; }

private:
    Buffer buffer;
    std::size_t capacity = 0;
};

} // namespace talus::render
