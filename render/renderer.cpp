// SPDX-License-Identifier: MIT
// Brings together the world's buffers, the painter and the canvas, in the right OpenGL context.
#include "render/renderer.h"

#include <optional>
#include <string>

#include "device/gl/gl_context.h"
#include "render/bodies_to_draw.h"
#include "render/canvas.h"
#include "render/painter.h"
#include "render/view.h"

namespace talus::render {

struct Renderer::Impl {
    Impl(const World& drawn, std::uint32_t w, std::uint32_t h, const scenes::Camera& seen_by, const Overlays& shown)
        : world(drawn), width(w), height(h), camera(seen_by), overlays(shown) {
        make_view(camera, 1, 1, 1.0f); // refuses a camera that cannot see
        if (world.device().kind == DeviceKind::Cpu) own_context = engine::OpenGlContext::own();
        make_current();
        painter.emplace();
        canvas.emplace(width, height);
        bodies.emplace();
    }

    ~Impl() {
        try {
            make_current();
        } catch (const Error&) {
            // Without its context nothing of it can be freed, and nothing needs to be.
        }
        bodies.reset();
        canvas.reset();
        painter.reset();
    }

    void make_current() {
        if (own_context)
            own_context->make_current();
        else
            world.make_gl_current();
    }

    void submit();

    const World& world;
    std::uint32_t width, height;
    scenes::Camera camera;
    Overlays overlays;
    std::unique_ptr<engine::OpenGlContext> own_context;
    std::optional<Painter> painter;
    std::optional<Canvas> canvas;
    std::optional<BodiesToDraw> bodies;
};

void Renderer::Impl::submit() {
    Drawing drawing;
    make_current();
    bodies->update(world, overlays, drawing);
    make_current(); // the calls on the world may have left it otherwise

    // What the solver's kernels wrote must be seen by the shaders, and be drawn before the next step changes it.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    canvas->begin();
    painter->paint(make_view(camera, width, height, bodies->typical_size()), drawing);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    canvas->send();
}

Renderer::Renderer(const World& world, std::uint32_t width, std::uint32_t height, const scenes::Camera& camera,
                   const Overlays& overlays)
    : impl_(std::make_unique<Impl>(world, width, height, camera, overlays)) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Picture Renderer::draw() {
    if (pending() > 0) throw Error("Renderer::draw: pictures are pending; collect them first");
    submit();
    return collect();
}

void Renderer::submit() {
    if (pending() == k_most_pending)
        throw Error("Renderer::submit: " + std::to_string(k_most_pending) +
                    " pictures are pending, and no more may be");
    impl_->submit();
}

std::size_t Renderer::pending() const noexcept {
    return impl_->canvas->pending();
}

Picture Renderer::collect() {
    if (pending() == 0) throw Error("Renderer::collect: no picture is pending; submit one first");
    impl_->make_current();
    return impl_->canvas->receive();
}

bool Renderer::draws_in_software() const noexcept {
    return impl_->own_context ? impl_->own_context->is_software() : impl_->world.device().in_software;
}

void Renderer::set_camera(const scenes::Camera& camera) {
    make_view(camera, 1, 1, 1.0f); // refuses a camera that cannot see
    impl_->camera = camera;
}

} // namespace talus::render
