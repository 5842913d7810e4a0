// SPDX-License-Identifier: MIT
// Does all that a frame of the window does, snapshots and measurements included, but for the panels themselves.
#include "viewer/offscreen.h"

#include <array>
#include <chrono>

#include <fmt/format.h>

#include "cli/interrupt.h"
#include "device/gl/gl_context.h"
#include "device/gl/gl_objects.h"
#include "viewer/camera_control.h"
#include "viewer/display.h"
#include "viewer/frame_times.h"
#include "viewer/measurements.h"

namespace talus::viewer {

namespace {

constexpr double k_default_time = 10.0;   // s
constexpr std::size_t k_frames_ahead = 2; // as a window's swap chain allows

} // namespace

void run_offscreen(const ViewOptions& options) {
    using Clock = std::chrono::steady_clock;
    const auto context = engine::OpenGlContext::own();
    context->make_current();
    const auto settings = [&](const scenes::Scene& scene) { return cli::settings_of(scene, options.simulation); };
    Session session(options.simulation.scene, options.simulation.device, options.simulation.threads, settings);
    CameraControl camera;
    camera.look_through(session.scene().camera, static_cast<float>(options.width) / static_cast<float>(options.height));
    Display display;
    display.overlays = options.overlays;
    Measurements measurements;

    std::array<engine::GlFence, k_frames_ahead> drawn;
    const auto draw = [&](std::size_t frame) {
        drawn[frame % k_frames_ahead].wait();
        if (!options.paused) session.step();
        measurements.update(session.world());
        display.draw(session, camera.camera(), options.width, options.height, 1.0f);
        drawn[frame % k_frames_ahead] = engine::GlFence::place();
    };
    draw(0); // compiles the kernels
    const std::uint64_t first_step = session.world().step_count();
    const std::chrono::duration<double> time(options.seconds.value_or(k_default_time));
    FrameTimes frames;
    const Clock::time_point start = Clock::now();
    for (std::size_t frame = 1; frame == 1 || Clock::now() - start < time; ++frame) {
        cli::check_interrupt();
        frames.begin();
        draw(frame);
        frames.end_work();
    }
    for (engine::GlFence& fence : drawn)
        fence.wait();
    const World& world = session.world();
    fmt::print("{} bodies, {} × {} pixels, {}, drawn by {}\n{}", world.body_count(), options.width, options.height,
               world.device().name, context->renderer(),
               frames.summary(static_cast<double>(world.step_count() - first_step) * world.settings().dt));
}

} // namespace talus::viewer
