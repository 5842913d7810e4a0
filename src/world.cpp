// SPDX-License-Identifier: MIT
// The public calls: check, then write into the host's table of bodies, or read what the device made. Changes go to the
// device in one batch before the next step.
#include <talus/world.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "body_table.h"
#include "checks.h"
#include "contact_events.h"
#include "device/cpu/cpu_threads.h"
#include "device/gl/callers_context.h"
#include "saved_state.h"
#include "simulation.h"
#include "state/formulas.h"
#include "step_results.h"

namespace talus {
using namespace engine;

struct World::Impl {
    Impl(const Settings& wanted, const WorldOptions& options)
        : simulation(options),
          own_context(options.gl_context == GlContext::Own && simulation.device().kind != DeviceKind::Cpu),
          host_threads(std::min(engine::threads_asked_for(options.threads), engine::available_threads())) {
        set_settings(wanted);
    }

    void set_settings(const Settings& wanted) {
        const CallersContext callers(own_context);
        simulation.set_settings(wanted);
        if (wanted != settings) table.wake_all(); // gravity may be another, and more
        settings = wanted;
    }

    /// The slot of a body that is there; otherwise an Error that begins with the call's name.
    uint slot_of(BodyId id, const char* call) const {
        if (table.contains(id)) return id.index;
        const bool known = table.is_known(id);
        throw Error(fmt::format("{}: body {} (generation {}) {}", call, id.index, id.generation,
                                known ? "was removed"
                                      : fmt::format("is not known; the world has {} bodies", table.body_count())));
    }

    /// The slot of a body that forces move.
    uint rigid_slot_of(BodyId id, const char* call) const {
        const uint slot = slot_of(id, call);
        if (table.kind_of(slot) != BodyKind::Rigid)
            throw Error(fmt::format("{}: body {} is {}; only rigid bodies are moved by forces and impulses", call, slot,
                                    to_words(table.kind_of(slot))));
        return slot;
    }

    /// The table's poses and velocities are those of the newest step, but for what the caller has changed since.
    void refresh() {
        if (table_step == simulation.step_count()) return;
        const CallersContext callers(own_context);
        std::vector<std::pair<uint, BodyPose>> poses;
        std::vector<std::pair<uint, BodyVelocity>> velocities;
        for (const uint slot : table.changed_slots()) {
            if (table.is_dirty(slot, k_dirty_pose)) poses.emplace_back(slot, table.poses[slot]);
            if (table.is_dirty(slot, k_dirty_velocity)) velocities.emplace_back(slot, table.velocities[slot]);
        }
        const std::size_t count = std::min(device_slots, table.slot_count());
        simulation.read_state(std::array{
            ReadRequest{BufferId::Poses, count * sizeof(BodyPose), table.poses.data()},
            ReadRequest{BufferId::Velocities, count * sizeof(BodyVelocity), table.velocities.data()},
        });
        for (const auto& [slot, pose] : poses)
            table.poses[slot] = pose;
        for (const auto& [slot, velocity] : velocities)
            table.velocities[slot] = velocity;
        table_step = simulation.step_count();
    }

    /// Makes events of what the finished steps have reported.
    void collect_events() {
        for (Simulation::StepReports& reports : simulation.take_reports())
            append_events(events, reports, table);
    }

    /// Before bodies come: who was in which slot is known as long as it is not used again.
    void finish_events() {
        const CallersContext callers(own_context);
        if (simulation.watches_contacts()) simulation.settle();
        collect_events();
    }

    /// For changing a body: the change will reach the device, and wakes what sleeps.
    void touch(uint slot, std::uint8_t what) {
        table.mark(slot, what);
        if (settings.sleeping) table.disturb(slot);
    }

    /// For giving a body a velocity: one that was frozen moves again.
    void thaw(uint slot) {
        refresh();
        touch(slot, k_dirty_pose | k_dirty_velocity);
        table.poses[slot].flags &= ~k_body_frozen;
        table.velocities[slot].inverse_mass = table.properties[slot].inverse_mass;
    }

    void note_new(std::span<const BodyId> ids) {
        steps_before.resize(table.slot_count());
        for (const BodyId id : ids) {
            steps_before[id.index] = simulation.step_count();
            if (settings.sleeping) table.disturb(id.index);
        }
    }

    /// The device gets room for all bodies, before anything that it then could not take back.
    BodyChanges take_changes() {
        simulation.reserve_bodies(table.slot_count());
        if (table.has_loads()) simulation.reserve_loads();
        device_slots = table.slot_count();
        return table.take_changes(simulation.has_room_for_loads(), host_threads);
    }

    void step(std::uint32_t count) {
        const CallersContext callers(own_context);
        for (std::uint32_t i = 0; i < count; ++i) {
            BodyChanges changes = take_changes();
            Population population = table.population();
            population.waking = table.take_waking();
            simulation.step(population, poses_wanted, std::move(changes));
            table.forget_loads();
            table.recycle();
        }
    }

    void restore(const SavedState& saved) {
        const CallersContext callers(own_context);
        simulation.restore(saved);
        simulation.set_settings(saved.settings);
        settings = saved.settings;
        table.restore(saved.table);
        events.clear();
        table_step = saved.report.step;
        device_slots = saved.counters[k_counter_body_count];
        steps_before.assign(table.slot_count(), table_step); // a frame of the time before is no longer there
    }

    template <typename T, typename F> std::vector<T> for_present(const F& value) const {
        std::vector<T> result;
        result.reserve(table.body_count());
        for (uint slot = 0; slot < table.slot_count(); ++slot)
            if (table.is_present(slot)) result.push_back(value(slot));
        return result;
    }

    bool both_present(uint a, uint b) const { return table.is_present(a) && table.is_present(b); }

    Simulation simulation;
    bool own_context;  ///< OpenGL is used, in a context of the world's own
    uint host_threads; ///< that may work on lists of many bodies
    Settings settings;
    BodyTable table;
    std::uint64_t table_step = 0; ///< the step whose poses and velocities the table holds
    uint device_slots = 0;        ///< body slots that the newest step knows of
    bool poses_wanted = false;
    std::vector<ContactEvent> events;        ///< that the caller has not taken yet
    std::vector<std::uint64_t> steps_before; ///< steps made before each slot's body was added
};

namespace {

static_assert(GlBuffers::pair_count_word == k_counter_pair_count);

} // namespace

World::World(const Settings& settings, const WorldOptions& options) {
    check_settings(settings);
    check_options(options);
    const CallersContext callers(options.device != DeviceKind::Cpu && options.gl_context == GlContext::Own);
    impl_ = std::make_unique<Impl>(settings, options);
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

// ---- bodies ----

BodyId World::add(const BodyDefinition& definition) {
    check_definition(definition, {"{0}", "add"});
    impl_->finish_events();
    const BodyId id = impl_->table.add(definition);
    impl_->note_new({&id, 1});
    return id;
}

std::vector<BodyId> World::add(std::span<const BodyDefinition> definitions) {
    check_definitions(definitions, impl_->host_threads);
    impl_->finish_events();
    std::vector<BodyId> ids = impl_->table.add(definitions, impl_->host_threads);
    impl_->note_new(ids);
    return ids;
}

void World::remove(BodyId id) {
    impl_->slot_of(id, "remove");
    impl_->table.remove(id);
}

bool World::contains(BodyId id) const noexcept {
    return impl_->table.contains(id);
}
std::size_t World::body_count() const noexcept {
    return impl_->table.body_count();
}

std::vector<BodyId> World::bodies() const {
    return impl_->for_present<BodyId>([&](uint slot) { return impl_->table.id_of(slot); });
}

BodyKind World::kind(BodyId id) const {
    return impl_->table.kind_of(impl_->slot_of(id, "kind"));
}
Shape World::shape(BodyId id) const {
    return unpack_shape(impl_->table.shapes[impl_->slot_of(id, "shape")]);
}
float World::mass(BodyId id) const {
    return impl_->table.masses[impl_->slot_of(id, "mass")];
}
Vec3 World::inertia(BodyId id) const {
    return impl_->table.inertias[impl_->slot_of(id, "inertia")];
}

Pose World::pose(BodyId id) const {
    const uint slot = impl_->slot_of(id, "pose");
    impl_->refresh();
    return from_record(impl_->table.poses[slot]);
}

void World::set_pose(BodyId id, const Pose& pose) {
    const uint slot = impl_->slot_of(id, "set_pose");
    check_pose(pose, body_of_call("set_pose", id));
    impl_->thaw(slot);
    impl_->touch(slot, k_dirty_contacts);
    impl_->table.poses[slot] = placed_at(pose);
}

Velocity World::velocity(BodyId id) const {
    const uint slot = impl_->slot_of(id, "velocity");
    impl_->refresh();
    return from_record(impl_->table.velocities[slot]);
}

void World::set_velocity(BodyId id, const Velocity& velocity) {
    const uint slot = impl_->slot_of(id, "set_velocity");
    check_velocity(velocity, body_of_call("set_velocity", id));
    if (kind(id) == BodyKind::Static)
        throw Error(body_of_call("set_velocity", id).in_words() + " is static; make it kinematic to move it");
    impl_->thaw(slot);
    BodyTable& table = impl_->table;
    table.velocities[slot] = {to_glm(velocity.linear), table.properties[slot].inverse_mass, to_glm(velocity.angular),
                              0};
}

std::vector<Pose> World::poses() const {
    impl_->refresh();
    return impl_->for_present<Pose>([&](uint slot) { return from_record(impl_->table.poses[slot]); });
}

std::vector<Velocity> World::velocities() const {
    impl_->refresh();
    return impl_->for_present<Velocity>([&](uint slot) { return from_record(impl_->table.velocities[slot]); });
}

void World::add_force(BodyId id, Vec3 force) {
    const uint slot = impl_->rigid_slot_of(id, "add_force");
    check_finite(force, body_of_call("add_force", id), "force");
    impl_->touch(slot, k_dirty_load);
    impl_->table.loads[slot].force += to_glm(force);
}

void World::add_force(BodyId id, Vec3 force, Vec3 point) {
    check_finite(point, body_of_call("add_force", id), "point");
    add_force(id, force);
    impl_->refresh();
    const uint slot = id.index;
    impl_->table.loads[slot].torque += cross3(to_glm(point) - impl_->table.poses[slot].position, to_glm(force));
}

void World::add_torque(BodyId id, Vec3 torque) {
    const uint slot = impl_->rigid_slot_of(id, "add_torque");
    check_finite(torque, body_of_call("add_torque", id), "torque");
    impl_->touch(slot, k_dirty_load);
    impl_->table.loads[slot].torque += to_glm(torque);
}

void World::add_impulse(BodyId id, Vec3 impulse) {
    const uint slot = impl_->rigid_slot_of(id, "add_impulse");
    check_finite(impulse, body_of_call("add_impulse", id), "impulse");
    impl_->refresh();
    BodyTable& table = impl_->table;
    const vec3 linear = table.velocities[slot].linear + to_glm(impulse) * table.properties[slot].inverse_mass;
    check_finite(from_glm(linear), body_of_call("add_impulse", id), "velocity after the impulse");
    impl_->thaw(slot);
    table.velocities[slot].linear = linear;
}

void World::add_impulse(BodyId id, Vec3 impulse, Vec3 point) {
    check_finite(point, body_of_call("add_impulse", id), "point");
    add_impulse(id, impulse);
    const vec3 arm = to_glm(point) - impl_->table.poses[id.index].position;
    add_angular_impulse(id, from_glm(cross3(arm, to_glm(impulse))));
}

void World::add_angular_impulse(BodyId id, Vec3 impulse) {
    const uint slot = impl_->rigid_slot_of(id, "add_angular_impulse");
    check_finite(impulse, body_of_call("add_angular_impulse", id), "angular impulse");
    impl_->refresh();
    BodyTable& table = impl_->table;
    const BodyInertia inertia =
        world_inertia(table.poses[slot].rotation, table.properties[slot].inverse_inertia, k_trait_movable, 0);
    const vec3 angular = table.velocities[slot].angular + multiply_inertia(inertia, to_glm(impulse));
    check_finite(from_glm(angular), body_of_call("add_angular_impulse", id), "angular velocity after the impulse");
    impl_->thaw(slot);
    table.velocities[slot].angular = angular;
}

bool World::is_asleep(BodyId id) const {
    const uint slot = impl_->slot_of(id, "is_asleep");
    impl_->refresh();
    return engine::is_asleep(impl_->table.poses[slot]);
}

void World::wake(BodyId id) {
    const uint slot = impl_->slot_of(id, "wake");
    if (impl_->settings.sleeping) impl_->table.disturb(slot);
}

float World::gravity_scale(BodyId id) const {
    return impl_->table.properties[impl_->slot_of(id, "gravity_scale")].gravity_scale;
}

void World::set_gravity_scale(BodyId id, float scale) {
    const uint slot = impl_->slot_of(id, "set_gravity_scale");
    check_finite(scale, body_of_call("set_gravity_scale", id), "gravity scale");
    impl_->touch(slot, k_dirty_properties);
    impl_->table.properties[slot].gravity_scale = scale;
}

Material World::material(BodyId id) const {
    return unpack_material(impl_->table.properties[impl_->slot_of(id, "material")]);
}

void World::set_material(BodyId id, const Material& material) {
    const uint slot = impl_->slot_of(id, "set_material");
    check_material(material, body_of_call("set_material", id));
    impl_->touch(slot, k_dirty_properties | k_dirty_contacts);
    BodyTable& table = impl_->table;
    BodyProperties& properties = table.properties[slot];
    table.bouncing_count += (material.restitution > 0.0f) - (properties.restitution > 0.0f);
    properties.friction = material.friction;
    properties.restitution = material.restitution;
    properties.combine = pack_combine(material);
}

bool World::is_sensor(BodyId id) const {
    return impl_->table.senses(impl_->slot_of(id, "is_sensor"));
}

void World::set_sensor(BodyId id, bool wanted) {
    const uint slot = impl_->slot_of(id, "set_sensor");
    impl_->touch(slot, k_dirty_shape | k_dirty_contacts);
    impl_->table.set_sensor(slot, wanted);
}

// ---- time ----

void World::step(std::uint32_t count) {
    impl_->step(count);
}
void World::wait() const {
    const CallersContext callers(impl_->own_context);
    impl_->simulation.settle();
}

Snapshot World::snapshot() const {
    impl_->refresh();
    const CallersContext callers(impl_->own_context);
    return Snapshot(std::make_shared<const SavedState>(save_state(impl_->simulation, impl_->table, impl_->settings)));
}

void World::restore(const Snapshot& snapshot) {
    impl_->restore(*snapshot.state_);
}

std::uint64_t World::step_count() const noexcept {
    return impl_->simulation.step_count();
}

// ---- results ----

std::vector<CollisionPair> World::collision_pairs() const {
    const CallersContext callers(impl_->own_context);
    std::vector<CollisionPair> result;
    for (const Pair& pair : read_pairs(impl_->simulation))
        if (impl_->both_present(pair.body_a, pair.body_b))
            result.push_back({impl_->table.id_of(pair.body_a), impl_->table.id_of(pair.body_b)});
    return result;
}

std::vector<Contact> World::contacts() const {
    const CallersContext callers(impl_->own_context);
    const ContactRecords records = read_contacts(impl_->simulation);
    std::vector<Contact> result;
    for (std::size_t i = 0; i < records.manifolds.size(); ++i) {
        const Manifold& manifold = records.manifolds[i];
        if (manifold.point_count == 0 || !impl_->both_present(manifold.body_a, manifold.body_b)) continue;
        Contact contact{impl_->table.id_of(manifold.body_a),
                        impl_->table.id_of(manifold.body_b),
                        from_glm(manifold.normal),
                        manifold.colour == k_inactive_colour,
                        {},
                        manifold.colour < k_no_colour ? manifold.colour & ~k_whole_hub : manifold.colour};
        const vec3 centre_a = records.starts[manifold.body_a].position;
        for (std::size_t k = 0; k < manifold.point_count; ++k)
            contact.points.push_back({from_glm(point_position(centre_a, records.points[4 * i + k].anchor)),
                                      records.separations[i].separation[static_cast<int>(k)],
                                      records.impulses[4 * i + k]});
        result.push_back(std::move(contact));
    }
    std::ranges::sort(result, {}, [](const Contact& c) { return std::pair(c.a.index, c.b.index); });
    return result;
}

StepReport World::report() const {
    const CallersContext callers(impl_->own_context);
    impl_->simulation.settle();
    return impl_->simulation.report();
}

std::uint64_t World::state_hash() const {
    impl_->refresh();
    // FNV-1a over words. Both zeros count as one: devices differ in which of the two a maximum gives.
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add_word = [&](float value) {
        hash = (hash ^ (value == 0.0f ? 0u : floatBitsToUint(value))) * 0x100000001b3u;
    };
    const BodyTable& table = impl_->table;
    for (uint slot = 0; slot < table.slot_count(); ++slot) {
        if (!table.is_present(slot)) continue;
        const BodyPose& pose = table.poses[slot];
        const BodyVelocity& velocity = table.velocities[slot];
        for (int i = 0; i < 3; ++i) {
            add_word(pose.position[i]);
            add_word(velocity.linear[i]);
            add_word(velocity.angular[i]);
        }
        for (int i = 0; i < 4; ++i)
            add_word(pose.rotation[i]);
    }
    return hash;
}

// ---- contact events ----

void World::watch_contacts(ContactWatch watch) {
    check_watch(watch);
    const CallersContext callers(impl_->own_context);
    impl_->simulation.watch_contacts(watch);
}

std::vector<ContactEvent> World::take_contact_events() {
    wait();
    impl_->collect_events();
    return std::exchange(impl_->events, {});
}

std::vector<ContactEvent> World::take_finished_contact_events() {
    const CallersContext callers(impl_->own_context);
    impl_->simulation.poll();
    impl_->collect_events();
    return std::exchange(impl_->events, {});
}

// ---- results without waiting ----

void World::keep_poses_coming(bool wanted) {
    impl_->poses_wanted = wanted;
}

World::PoseFrame World::newest_poses() const {
    const CallersContext callers(impl_->own_context);
    impl_->simulation.poll();
    const std::span<const BodyPose> poses = impl_->simulation.newest_poses();
    PoseFrame frame;
    if (poses.empty()) return frame;
    frame.step = impl_->simulation.report().step;
    const BodyTable& table = impl_->table;
    for (uint slot = 0; slot < std::min<std::size_t>(poses.size(), table.slot_count()); ++slot) {
        if (!table.is_present(slot) || impl_->steps_before[slot] >= frame.step) continue;
        frame.bodies.push_back(table.id_of(slot));
        frame.poses.push_back(from_record(poses[slot]));
    }
    return frame;
}

// ---- the rest ----

const Settings& World::settings() const noexcept {
    return impl_->settings;
}

void World::set_settings(const Settings& settings) {
    check_settings(settings);
    impl_->set_settings(settings);
}

Transfers World::transfers() const noexcept {
    return impl_->simulation.transfers();
}

const DeviceInfo& World::device() const noexcept {
    return impl_->simulation.device();
}

MemoryUse World::memory() const noexcept {
    const BodyTable& table = impl_->table;
    const std::size_t per_body = sizeof(BodyPose) + sizeof(BodyVelocity) + sizeof(BodyShape) + sizeof(BodyProperties) +
                                 sizeof(BodyLoad) + sizeof(float) + sizeof(Vec3) + 6;
    return {impl_->simulation.memory_bytes(), table.slot_count() * per_body};
}

GlBuffers World::gl_buffers() const {
    if (impl_->simulation.gpu_device() == nullptr)
        throw Error("gl_buffers: the world runs on the CPU, which has no OpenGL buffers");
    Device& device = *impl_->simulation.gpu_device();
    const CallersContext callers(impl_->own_context);
    const BodyChanges changes = impl_->take_changes();
    impl_->simulation.change_bodies(impl_->table.population(), changes);
    impl_->simulation.show_on_gpu();
    const auto name_of = [&device](BufferId buffer) { return device.gl_range(buffer).buffer; };
    GlBuffers names;
    names.poses = name_of(BufferId::Poses);
    names.starts = name_of(BufferId::Starts);
    names.shapes = name_of(BufferId::Shapes);
    names.aabbs = name_of(BufferId::Aabbs);
    names.pairs = name_of(BufferId::Pairs);
    names.manifolds = device.gl_range(BufferId::OldManifolds);
    names.contact_points = device.gl_range(BufferId::OldManifoldPoints);
    names.point_separations = device.gl_range(BufferId::OldPointSeparations);
    names.point_impulses = device.gl_range(BufferId::OldPointImpulses);
    names.counters = name_of(BufferId::Counters);
    names.body_capacity = impl_->table.slot_count();
    names.pair_capacity = impl_->simulation.report().pairs;
    return names;
}

void World::make_gl_current() const {
    if (Device* gpu = impl_->simulation.gpu_device()) gpu->make_current();
}

std::span<const char* const> stage_names() noexcept {
    return k_stage_names;
}

} // namespace talus
