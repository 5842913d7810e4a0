// SPDX-License-Identifier: MIT
// Four samples a pixel in sRGB storage, so that blending and the average of the samples happen in linear light. The
// resolved picture is copied into persistently mapped buffers, each guarded by a fence.
#include "render/canvas.h"

#include <algorithm>
#include <string>

#include <talus/types.h>

namespace talus::render {

Canvas::Canvas(std::uint32_t w, std::uint32_t h) : width(w), height(h) {
    GLint most = 0, most_samples = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
    glGetIntegerv(GL_MAX_SAMPLES, &most_samples);
    if (width == 0 || height == 0 || width > static_cast<std::uint32_t>(most) ||
        height > static_cast<std::uint32_t>(most))
        throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels cannot be drawn; each side may have 1 to " + std::to_string(most) + " here");
    const auto columns = static_cast<GLsizei>(width), rows = static_cast<GLsizei>(height);
    const GLint samples = std::min(4, most_samples);

    drawn_colour = make_renderbuffer();
    drawn_depth = make_renderbuffer();
    resolved_colour = make_renderbuffer();
    glNamedRenderbufferStorageMultisample(drawn_colour, samples, GL_SRGB8_ALPHA8, columns, rows);
    glNamedRenderbufferStorageMultisample(drawn_depth, samples, GL_DEPTH_COMPONENT32F, columns, rows);
    glNamedRenderbufferStorage(resolved_colour, GL_SRGB8_ALPHA8, columns, rows);
    drawn = make_framebuffer();
    resolved = make_framebuffer();
    glNamedFramebufferRenderbuffer(drawn, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, drawn_colour);
    glNamedFramebufferRenderbuffer(drawn, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, drawn_depth);
    glNamedFramebufferRenderbuffer(resolved, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolved_colour);
    for (const GLuint framebuffer : {GLuint{drawn}, GLuint{resolved}}) {
        if (glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw Error("this OpenGL driver gives no target for a picture of " + std::to_string(width) + " x " +
                        std::to_string(height) + " pixels");
    }

    for (ReadBack& slot : ring)
        slot.buffer = engine::GlBuffer("picture on its way to the host", std::size_t{4} * width * height,
                                       GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT);
}

void Canvas::begin() {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, drawn);
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glEnable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_MULTISAMPLE);
}

void Canvas::resolve() {
    const auto columns = static_cast<GLint>(width), rows = static_cast<GLint>(height);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glBlitNamedFramebuffer(drawn, resolved, 0, 0, columns, rows, 0, 0, columns, rows, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Canvas::show(GLuint framebuffer, std::uint32_t left, std::uint32_t columns, std::uint32_t rows) {
    resolve();
    // A window's pixels are sRGB already, whether or not its framebuffer says so: they are copied as they are.
    glDisable(GL_FRAMEBUFFER_SRGB);
    const auto right = static_cast<GLint>(std::min(columns, width)), top = static_cast<GLint>(std::min(rows, height));
    const auto start = static_cast<GLint>(left);
    glBlitNamedFramebuffer(resolved, framebuffer, 0, 0, right, top, start, 0, start + right, top, GL_COLOR_BUFFER_BIT,
                           GL_NEAREST);
}

void Canvas::send() {
    resolve();
    const auto columns = static_cast<GLint>(width), rows = static_cast<GLint>(height);
    ReadBack& slot = ring[sent % k_ring_size];
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, columns, rows, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    slot.fence = engine::GlFence::place();
    glFlush();
    ++sent;
}

Picture Canvas::receive() {
    ReadBack& slot = ring[received % k_ring_size];
    slot.fence.wait();
    ++received;

    Picture picture{width, height, {}};
    picture.rgb.resize(std::size_t{3} * width * height);
    const auto* pixels = reinterpret_cast<const std::uint8_t*>(slot.buffer.mapped());
    std::uint8_t* out = picture.rgb.data();
    for (std::uint32_t y = height; y-- > 0;) { // OpenGL's rows run upwards
        const std::uint8_t* in = pixels + std::size_t{4} * width * y;
        for (std::uint32_t x = 0; x < width; ++x, in += 4, out += 3) {
            out[0] = in[0];
            out[1] = in[1];
            out[2] = in[2];
        }
    }
    return picture;
}

} // namespace talus::render
