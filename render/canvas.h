// SPDX-License-Identifier: MIT
// Where pictures are drawn, and their way back to the host, which does not stall the GPU.
#pragma once

#include <array>
#include <cstdint>

#include "device/gl/gl_objects.h"
#include "render/gl_names.h"
#include "render/picture.h"

namespace talus::render {

/// A multisampled target and a ring of read-back buffers.
class Canvas {
public:
    /// Pictures that may be on their way at once.
    static constexpr std::size_t k_ring_size = 3;

    /// Throws Error for a size that this OpenGL driver does not offer.
    Canvas(std::uint32_t width, std::uint32_t height);

    /// Makes it the target of what is drawn next.
    void begin();
    /// Sends what was drawn on its way. There must be room in the ring.
    void send();
    /// Puts what was drawn into another framebuffer, such as a window's, pixel by pixel: this much of it, with its
    /// lower left corner `left` pixels from that one's.
    void show(GLuint framebuffer, std::uint32_t left, std::uint32_t columns, std::uint32_t rows);
    /// The oldest picture that was sent; waits for it. There must be one.
    Picture receive();
    std::size_t pending() const noexcept { return sent - received; }

private:
    void resolve();

    struct ReadBack {
        engine::GlBuffer buffer;
        engine::GlFence fence;
    };

    std::uint32_t width, height;
    Renderbuffer drawn_colour, drawn_depth, resolved_colour;
    Framebuffer drawn, resolved;
    std::array<ReadBack, k_ring_size> ring;
    std::size_t sent = 0, received = 0;
};

} // namespace talus::render
