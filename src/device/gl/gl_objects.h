// SPDX-License-Identifier: MIT
// OpenGL objects that free themselves: buffers with immutable storage, and fences. The context that they belong to must
// be current whenever one is made, used or destroyed.
#pragma once

#include <cstddef>
#include <string>

#include <epoxy/gl.h>

namespace talus::engine {

class GlBuffer {
public:
    GlBuffer() = default;
    /// `flags` as of glNamedBufferStorage; with GL_MAP_PERSISTENT_BIT the buffer stays mapped for its whole life. The
    /// content is undefined. Throws Error where the driver has no memory for it.
    GlBuffer(const std::string& label, std::size_t bytes, GLbitfield flags = 0);
    ~GlBuffer();
    GlBuffer(GlBuffer&&) noexcept;
    GlBuffer& operator=(GlBuffer&&) noexcept;

    GLuint name() const noexcept { return name_; }
    std::size_t size() const noexcept { return size_; }
    std::byte* mapped() const noexcept { return mapped_; }
    void label(const std::string&) const;

private:
    GLuint name_ = 0;
    std::size_t size_ = 0;
    std::byte* mapped_ = nullptr;
};

/// Says whether the GPU has finished all that was given to it before the fence was placed.
class GlFence {
public:
    GlFence() = default; ///< Always passed.
    static GlFence place();
    ~GlFence();
    GlFence(GlFence&&) noexcept;
    GlFence& operator=(GlFence&&) noexcept;

    bool passed();
    void wait();

private:
    /// Drops the fence once the GPU has passed it.
    bool poll(GLbitfield flags, GLuint64 nanoseconds);

    GLsync sync_ = nullptr;
};

} // namespace talus::engine
