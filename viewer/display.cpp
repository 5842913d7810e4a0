// SPDX-License-Identifier: MIT
#include "viewer/display.h"

#include <array>

#include "render/view.h"

namespace talus::viewer {

namespace {

std::uint32_t even(std::uint32_t value) {
    return value + value % 2;
}

} // namespace

void Display::fit_canvas(std::uint32_t width, std::uint32_t height) {
    // Videos need even sides; the window shows a pixel less.
    if (canvas && canvas_width == even(width) && canvas_height == even(height)) return;
    finish_video(); // its pictures have one size
    canvas.reset();
    canvas.emplace(even(width), even(height));
    canvas_width = even(width);
    canvas_height = even(height);
}

void Display::draw(const Session& session, const scenes::Camera& camera, std::uint32_t width, std::uint32_t height,
                   float content_scale, std::span<const render::Line> more) {
    fit_canvas(width, height);
    if (!bodies || generation != session.generation()) {
        bodies.emplace();
        generation = session.generation();
    }
    render::Drawing drawing;
    drawing.pixel_scale = content_scale;
    bodies->update(session.world(), overlays, drawing, more);

    // What the solver's kernels wrote must be seen by the shaders, and be drawn before the next step changes it.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    canvas->begin();
    painter.paint(render::make_view(camera, canvas_width, canvas_height, bodies->typical_size()), drawing);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void Display::show(const Region& region) {
    constexpr std::array<float, 4> k_dark{0.09f, 0.10f, 0.12f, 1.0f}; // behind the panels
    glClearNamedFramebufferfv(0, GL_COLOR, 0, k_dark.data());
    canvas->show(0, region.left, region.width, region.height);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void Display::save_picture(const std::filesystem::path& path) {
    if (!canvas) throw Error("view: nothing has been drawn yet");
    while (canvas->pending() > 0)
        collect();
    canvas->send();
    render::write_png(path, canvas->receive());
}

void Display::start_video(const std::filesystem::path& path) {
    if (!canvas) throw Error("view: nothing has been drawn yet");
    video = std::make_unique<render::VideoWriter>(path, canvas_width, canvas_height, 1.0 / k_frame_time.count());
}

void Display::record() {
    if (!video) return;
    canvas->send();
    if (canvas->pending() == render::Canvas::k_ring_size) collect();
}

void Display::collect() {
    const render::Picture picture = canvas->receive();
    if (!video) return;
    try {
        video->add(picture);
    } catch (const Error&) {
        video.reset();
        throw;
    }
}

void Display::finish_video() {
    if (!video) return;
    while (canvas->pending() > 0)
        collect();
    const std::unique_ptr<render::VideoWriter> finished = std::move(video);
    finished->finish();
}

} // namespace talus::viewer
