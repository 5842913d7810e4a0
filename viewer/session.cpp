// SPDX-License-Identifier: MIT
#include "viewer/session.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

namespace talus::viewer {

namespace {

// A frame may spend this long on steps; what is owed beyond is forgotten, and the scene plays slower than it was asked
// to.
constexpr std::chrono::duration<double> k_longest_stepping{0.05};

std::vector<BodyDefinition> definitions_of(const scenes::Scene& scene) {
    std::vector<BodyDefinition> definitions;
    definitions.reserve(scene.bodies.size());
    for (const scenes::NamedBody& body : scene.bodies)
        definitions.push_back(body.definition);
    return definitions;
}

} // namespace

DeviceKind device_for_window(DeviceKind wanted) {
    if (wanted != DeviceKind::Auto) return wanted;
    const std::string_view renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    for (const char* software : {"llvmpipe", "softpipe", "swrast", "SWR", "lavapipe", "Software Rasterizer"})
        if (renderer.find(software) != std::string_view::npos) return DeviceKind::Cpu;
    return DeviceKind::Gpu;
}

Session::Session(const std::string& specification, DeviceKind kind, std::uint32_t thread_count, Adjust settings)
    : initial_settings(std::move(settings)), threads(thread_count), source(scenes::make_scene(specification)) {
    take(fill_world(source, initial_settings(source), device_for_window(kind)));
}

World Session::make_world(const Settings& settings, DeviceKind kind) const {
    WorldOptions options;
    options.device = kind;
    options.threads = threads;
    options.gl_context = GlContext::Current;
    options.profile = true;
    return World(settings, options);
}

World Session::fill_world(const scenes::Scene& scene, const Settings& settings, DeviceKind kind) const {
    World world = make_world(settings, kind);
    world.add(definitions_of(scene));
    return world;
}

void Session::take(World&& world) {
    if (simulated)
        *simulated = std::move(world);
    else
        simulated = std::make_unique<World>(std::move(world));
    ++world_number;
    due = 0.0;
}

void Session::open(const std::string& specification) {
    scenes::Scene scene = scenes::make_scene(specification);
    take(fill_world(scene, initial_settings(scene), device()));
    source = std::move(scene);
    past.clear();
}

void Session::reset() {
    take(fill_world(source, simulated->settings(), device()));
    past.clear();
}

void Session::move_to(DeviceKind kind) {
    World world = make_world(simulated->settings(), device_for_window(kind));
    world.restore(simulated->snapshot());
    take(std::move(world)); // the past stays: snapshots suit every device
}

void Session::advance(std::chrono::duration<double> elapsed) {
    if (!running) return;
    const double dt = simulated->settings().dt;
    due += speed * elapsed.count();
    const Clock::time_point start = Clock::now();
    double made = 0.0;
    while (due >= dt) {
        step();
        due -= dt;
        made += dt;
        if (Clock::now() - start > k_longest_stepping) due = std::min(due, 0.5 * dt);
    }
    if (elapsed.count() > 0.0) achieved += 0.1 * (made / elapsed.count() - achieved);
}

void Session::step() {
    if (before_step && before_step(*simulated)) past.note_change();
    if (keep_past)
        past.before_step(*simulated);
    else
        past.clear();
    simulated->step();
}

bool Session::step_back() {
    return past.step_back(*simulated);
}

World& Session::change() {
    past.note_change();
    return *simulated;
}

void Session::save(const std::filesystem::path& path) {
    simulated->snapshot().save(path);
}

void Session::load(const std::filesystem::path& path) {
    simulated->restore(Snapshot::load(path));
    past.clear();
    ++world_number;
    due = 0.0;
}

} // namespace talus::viewer
