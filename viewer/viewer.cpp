// SPDX-License-Identifier: MIT
// The loop: what the user does, what the world does, and a picture of it.
#include "viewer/viewer.h"

#include <chrono>
#include <cmath>
#include <thread>

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>

#include "cli/interrupt.h"
#include "cli/words.h"
#include "viewer/frame_times.h"
#include "viewer/keys.h"
#include "viewer/offscreen.h"
#include "viewer/panels.h"
#include "viewer/ui.h"
#include "viewer/window.h"
#include "viewer/workbench.h"

namespace talus::viewer {

namespace {

using Clock = std::chrono::steady_clock;

// Panels need some frames to settle after something has happened; later a paused scene costs next to nothing.
constexpr int k_frames_after_input = 4;
constexpr float k_haste = 4.0f;                                 // with Shift, flying is so much faster
constexpr double k_idle_wait = 0.25;                            // s
constexpr std::chrono::duration<double> k_longest_elapsed{0.1}; // after a halt, time is not made up for

double simulated_seconds(const World& world) {
    return static_cast<double>(world.step_count()) * world.settings().dt;
}

class Viewer : InputHandler {
public:
    explicit Viewer(const ViewOptions& options)
        : window(options.width, options.height, *this), ui(window),
          bench(options.simulation.scene, options.simulation.device, options.simulation.threads,
                [simulation = options.simulation](const scenes::Scene& scene) {
                    return cli::settings_of(scene, simulation);
                }) {
        const Region region = picture();
        bench.aspect = static_cast<float>(region.width) / static_cast<float>(std::max(region.height, 1u));
        bench.look_from_start();
        bench.display.overlays = options.overlays;
        bench.session.running = !options.paused;
        bench.say(fmt::format("{}", fmt::join(bench.session.scene().warnings, "\n")));
    }

    /// Until the window is closed, or for so long.
    void run(std::optional<double> seconds) {
        const Clock::time_point start = Clock::now();
        Clock::time_point last = start;
        FrameTimes frames;
        while (!window.should_close()) {
            if (seconds && std::chrono::duration<double>(last - start).count() >= *seconds) break;
            if (bench.session.running || busy_frames > 0)
                glfwPollEvents();
            else
                glfwWaitEventsTimeout(k_idle_wait);
            cli::check_interrupt();
            const Clock::time_point now = Clock::now();
            const auto elapsed = std::min(std::chrono::duration<double>(now - last), k_longest_elapsed);
            last = now;
            if (busy_frames > 0) --busy_frames;
            frames.begin();
            frame(elapsed);
            frames.end_work();
            // Where the system does not wait for the screen's refresh, as without a screen.
            std::this_thread::sleep_until(now + std::chrono::duration<double>(0.95 / window.refresh_rate()));
        }
        if (seconds) fmt::print("{}", frames.summary(simulated_seconds(bench.session.world())));
        bench.display.finish_video(); // here its error ends the program: there is no window any more to tell it
    }

private:
    void frame(std::chrono::duration<double> elapsed);
    void move_by_keys(float seconds);
    /// Through the mouse.
    Ray pointer() const;
    /// Where the scene is drawn: what the panels leave free.
    Region picture() const;
    std::string title() const;

    void key_pressed(int key, bool, bool control, bool repeated) override {
        busy_frames = k_frames_after_input;
        ui.note_key(key);
        if (!ui.wants_keyboard()) press_key(key, control, repeated, {bench, window, pointer()});
    }
    void mouse_pressed(MouseButton, bool shift) override;
    void mouse_released(MouseButton) override;
    void mouse_moved(glm::vec2 position, glm::vec2 movement) override;
    void wheel_turned(float notches) override;
    void files_dropped(const std::vector<std::filesystem::path>& files) override {
        busy_frames = k_frames_after_input;
        for (const std::filesystem::path& file : files)
            bench.open(file.string());
    }

    enum class Drag { None, Turn, Pan };

    Window window;
    Ui ui;
    Workbench bench;
    Panels panels;
    Drag drag = Drag::None;
    int busy_frames = k_frames_after_input;
};

Ray Viewer::pointer() const {
    const Region region = picture();
    const glm::vec2 size(std::max(region.width, 1u), std::max(region.height, 1u));
    const glm::vec2 mouse = window.mouse_position() - glm::vec2(region.left, 0.0f);
    const glm::vec2 place(2.0f * mouse.x / size.x - 1.0f, 1.0f - 2.0f * mouse.y / size.y);
    return {bench.camera.eye(), bench.camera.ray_through(place, size.x / size.y)};
}

Region Viewer::picture() const {
    const glm::uvec2 size = window.framebuffer_size();
    const std::uint32_t left = std::min(Panels::width(bench, window.content_scale()), size.x / 2);
    return {left, size.x - left, size.y};
}

void Viewer::mouse_pressed(MouseButton button, bool shift) {
    busy_frames = k_frames_after_input;
    if (ui.wants_mouse()) return;
    if (button == MouseButton::Middle || (button == MouseButton::Left && shift))
        drag = Drag::Pan;
    else if (button == MouseButton::Right || !bench.take_hold(pointer()))
        drag = Drag::Turn;
}

void Viewer::mouse_released(MouseButton button) {
    busy_frames = k_frames_after_input;
    drag = Drag::None;
    if (button == MouseButton::Left) bench.let_go();
}

void Viewer::mouse_moved(glm::vec2, glm::vec2 movement) {
    busy_frames = k_frames_after_input;
    const glm::vec2 share = movement / static_cast<float>(std::max(window.framebuffer_size().y, 1u));
    if (drag == Drag::Turn) bench.camera.turn(share);
    if (drag == Drag::Pan) bench.camera.pan(share);
}

void Viewer::wheel_turned(float notches) {
    busy_frames = k_frames_after_input;
    if (ui.wants_mouse()) return;
    if (bench.hand.is_holding())
        bench.reach(notches);
    else
        bench.camera.zoom(notches);
}

void Viewer::move_by_keys(float seconds) {
    if (ui.wants_keyboard()) return;
    const auto axis = [&](int forth, int back) {
        return static_cast<float>(window.is_key_down(forth)) - static_cast<float>(window.is_key_down(back));
    };
    const bool control = window.is_key_down(GLFW_KEY_LEFT_CONTROL) || window.is_key_down(GLFW_KEY_RIGHT_CONTROL);
    const glm::vec3 flight(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S));
    if (flight != glm::vec3(0.0f) && !control) {
        const bool shift = window.is_key_down(GLFW_KEY_LEFT_SHIFT) || window.is_key_down(GLFW_KEY_RIGHT_SHIFT);
        bench.camera.fly(flight, shift ? k_haste * seconds : seconds);
        busy_frames = k_frames_after_input;
    }
    bench.drive({axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT), axis(GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN),
                 axis(GLFW_KEY_UP, GLFW_KEY_DOWN)});
}

std::string Viewer::title() const {
    const Session& session = bench.session;
    return fmt::format("Talus: {} - step {} - {} - {} - {} bodies", session.scene().name, session.world().step_count(),
                       session.running ? "running" : "paused", cli::word_of(cli::device_words(), session.device()),
                       session.world().body_count());
}

void Viewer::frame(std::chrono::duration<double> elapsed) {
    move_by_keys(static_cast<float>(elapsed.count()));
    const bool was_running = bench.session.running;
    bench.advance(elapsed, pointer());

    const Region region = picture();
    if (region.width == 0 || region.height == 0) return;
    bench.aspect = static_cast<float>(region.width) / static_cast<float>(region.height);
    std::vector<render::Line> lines;
    if (const auto pull = bench.hand.pull(bench.session.world()))
        render::add_arrow(lines, pull->first, pull->second, render::pack_colour({1.0f, 0.9f, 0.2f}));
    const bool was_recording = bench.display.is_recording();
    bench.attempt([&] {
        bench.display.draw(bench.session, bench.camera.camera(), region.width, region.height, window.content_scale(),
                           lines);
        bench.display.show(region);
        if (was_recording && !bench.display.is_recording()) bench.say("the picture's size has changed: the video ends");
        if (was_running) bench.display.record();
    });
    bench.after_draw();

    ui.begin();
    panels.show(bench, window.content_scale());
    ui.end();
    window.set_title(title());
    window.swap();
}

} // namespace

void run_viewer(const ViewOptions& options) {
    if (options.offscreen)
        run_offscreen(options);
    else
        Viewer(options).run(options.seconds);
}

} // namespace talus::viewer
