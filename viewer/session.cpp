// SPDX-License-Identifier: MIT
#include "viewer/session.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "device/gl/gl_context.h"
#include "scenes/camera.h"

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

/// Sees all bodies that can move; of a world without any, all.
scenes::Camera camera_for(const World& world) {
    std::optional<scenes::Bounds> bounds;
    for (const bool movable : {true, false}) {
        for (const BodyId id : world.bodies()) {
            if (bounds && !movable) break;
            if (movable == (world.kind(id) == BodyKind::Static)) continue;
            const Vec3 p = world.pose(id).position;
            const Shape shape = world.shape(id);
            const auto* box = std::get_if<Box>(&shape);
            const float reach = box != nullptr ? 0.5f * std::hypot(box->size.x, box->size.y, box->size.z)
                                               : std::get<Sphere>(shape).radius;
            if (!bounds) bounds = scenes::Bounds{p, p};
            bounds->lower = {std::min(bounds->lower.x, p.x - reach), std::min(bounds->lower.y, p.y - reach),
                             std::min(bounds->lower.z, p.z - reach)};
            bounds->upper = {std::max(bounds->upper.x, p.x + reach), std::max(bounds->upper.y, p.y + reach),
                             std::max(bounds->upper.z, p.z + reach)};
        }
    }
    return bounds ? scenes::frame(*bounds, {0.6f, 0.35f, 1.0f}) : scenes::Camera{};
}

} // namespace

DeviceKind device_for_window(DeviceKind wanted) {
    if (wanted != DeviceKind::Auto) return wanted;
    return engine::OpenGlContext::current()->is_software() ? DeviceKind::Cpu : DeviceKind::Gpu;
}

Session::Session(const std::string& specification, DeviceKind kind, std::uint32_t thread_count, Adjust settings)
    : initial_settings(std::move(settings)), threads(thread_count), source(find_start(specification)) {
    take(world_at(source, device_for_window(kind)));
}

Session::Start Session::find_start(const std::string& specification) {
    if (std::filesystem::path(specification).extension() != ".snapshot") return {scenes::make_scene(specification), {}};
    Start start{{}, Snapshot::load(specification)};
    start.scene.name = specification;
    WorldOptions options;
    options.device = DeviceKind::Cpu;
    options.threads = 1;
    World world({}, options);
    world.restore(*start.snapshot);
    start.scene.settings = world.settings();
    start.scene.camera = camera_for(world);
    return start;
}

World Session::make_world(const Settings& settings, DeviceKind kind) const {
    WorldOptions options;
    options.device = kind;
    options.threads = threads;
    options.gl_context = GlContext::Current;
    options.profile = true;
    return World(settings, options);
}

World Session::world_at(const Start& start, DeviceKind kind) const {
    const Settings settings = initial_settings(start.scene);
    World world = make_world(settings, kind);
    if (start.snapshot) {
        world.restore(*start.snapshot);
        world.set_settings(settings); // the snapshot's, with what the user asked for on top
    } else {
        world.add(definitions_of(start.scene));
    }
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
    Start start = find_start(specification);
    take(world_at(start, device()));
    source = std::move(start);
    past.clear();
}

void Session::reset() {
    const Settings settings = simulated->settings();
    take(world_at(source, device()));
    simulated->set_settings(settings);
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
