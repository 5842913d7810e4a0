// SPDX-License-Identifier: MIT
// Pictures of a world, drawn without a window. A world on a GPU is drawn straight from the solver's buffers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <talus/world.h>

#include "render/overlays.h"
#include "render/picture.h"
#include "scenes/scene.h"

namespace talus::render {

/// Draws one world: static bodies blue, rigid ones green, kinematic ones orange, sensors turquoise and translucent.
class Renderer {
public:
    /// Most pictures that may be on their way at once.
    static constexpr std::size_t k_most_pending = 3;

    /// On a GPU (or hybrid) world the renderer works in the world's OpenGL context and leaves its state changed; for a
    /// world on the CPU it makes a headless context of its own. The world must stay where it is, and outlive the
    /// renderer. Throws Error for an impossible size or camera, and where OpenGL 4.5 cannot be had.
    Renderer(const World&, std::uint32_t width, std::uint32_t height, const scenes::Camera&, const Overlays& = {});
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// The world as it is now. No picture may be pending.
    Picture draw();

    /// For videos, two halves of `draw`, so that the GPU draws one picture while the host takes in another:
    ///
    ///     renderer.submit();
    ///     if (renderer.pending() == Renderer::k_most_pending) video.add(renderer.collect());
    ///
    /// Draws the world as it is now, and does not wait for the picture. Throws Error with k_most_pending on their way.
    void submit();
    std::size_t pending() const noexcept;
    /// The oldest picture on its way; waits for it. Throws Error if there is none.
    Picture collect();

    void set_camera(const scenes::Camera&);
    /// Whether OpenGL runs without a GPU here, where a picture takes a tenth of a second rather than a thousandth.
    bool draws_in_software() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace talus::render
