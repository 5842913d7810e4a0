// SPDX-License-Identifier: MIT
#include "body_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include "fresh_memory.h"
#include "host_loops.h"
#include "log.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

constexpr std::size_t k_many_bodies = 8192; // to be worth other threads

BodyShape pack_shape(const Shape& shape, BodyKind kind, bool sensor) {
    const uint kind_bits = static_cast<uint>(kind) << 8 | (sensor ? k_sensor_bit : 0u);
    if (const auto* box = std::get_if<Box>(&shape)) return {to_glm(box->size) * 0.5f, k_shape_box | kind_bits};
    return {vec3(std::get<Sphere>(shape).radius), k_shape_sphere | kind_bits};
}

} // namespace

MassProperties mass_properties(const BodyDefinition& definition) {
    MassProperties result{};
    if (const auto* box = std::get_if<Box>(&definition.shape)) {
        const auto [x, y, z] = box->size;
        result.mass = definition.mass.value_or(definition.density * x * y * z);
        const float twelfth = result.mass / 12.0f;
        result.inertia = {twelfth * (y * y + z * z), twelfth * (x * x + z * z), twelfth * (x * x + y * y)};
    } else {
        const float radius = std::get<Sphere>(definition.shape).radius;
        const float volume = 4.18879020f * radius * radius * radius; // 4/3 pi r^3
        result.mass = definition.mass.value_or(definition.density * volume);
        const float moment = 0.4f * result.mass * radius * radius;
        result.inertia = {moment, moment, moment};
    }
    result.inertia = definition.inertia.value_or(result.inertia);
    return result;
}

vec3 to_glm(Vec3 v) {
    return {v.x, v.y, v.z};
}
vec4 to_glm(Quat q) {
    return {q.x, q.y, q.z, q.w};
}
Vec3 from_glm(vec3 v) {
    return {v.x, v.y, v.z};
}

float length_of(Quat q) {
    return std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
}

BodyPose placed_at(const Pose& pose) {
    const auto [x, y, z, w] = pose.rotation;
    const float length = length_of(pose.rotation);
    return {to_glm(pose.position), k_body_placed, {x / length, y / length, z / length, w / length}};
}

Pose from_record(const BodyPose& pose) {
    return {from_glm(pose.position), {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w}};
}

Velocity from_record(const BodyVelocity& velocity) {
    return {from_glm(velocity.linear), from_glm(velocity.angular)};
}

uint pack_combine(const Material& material) {
    return static_cast<uint>(material.friction_combine) | static_cast<uint>(material.restitution_combine) << 8;
}

Material unpack_material(const BodyProperties& properties) {
    return {properties.friction, properties.restitution, static_cast<Combine>(properties.combine & 255u),
            static_cast<Combine>(properties.combine >> 8)};
}

Shape unpack_shape(const BodyShape& shape) {
    if ((shape.type & 255u) == k_shape_box) return Box{from_glm(shape.half_extents * 2.0f)};
    return Sphere{shape.half_extents.x};
}

void BodyTable::reserve(std::size_t more, uint threads) {
    const std::size_t count = slot_count() + more - std::min(more, slot_count() - present_count);
    const auto grow = [threads](auto& list, std::size_t wanted) {
        reserve_touched(list, wanted, threads, 2 * list.capacity());
    };
    for_each_slot_list([&](auto& list) { grow(list, count); });
    grow(generations, count);
    grow(next_generations, count);
    grow(changed, changed.size() + more);
}

void BodyTable::append_slots(std::size_t count, uint threads) {
    const std::size_t slots = uses.size() + count;
    const auto reserve_slots = [slots](auto& list) {
        if (list.capacity() < slots) list.reserve(std::max(slots, 2 * list.capacity()));
    };
    for_each_slot_list(reserve_slots); // where there is no memory no list is longer than another
    reserve_slots(generations);
    reserve_slots(next_generations);
    if (threads > 1 && count >= k_many_bodies) {
        std::vector<std::function<void()>> tasks;
        for_each_slot_list([&](auto& list) { tasks.emplace_back([&list, slots] { list.resize(slots); }); });
        side_by_side(threads, tasks);
    } else {
        for_each_slot_list([&](auto& list) { list.resize(slots); });
    }
    generations.resize(std::max(generations.size(), slots));
    next_generations.resize(std::max(next_generations.size(), slots));
}

void BodyTable::drop_last_slot() {
    for_each_slot_list([](auto& list) { list.pop_back(); });
}

uint BodyTable::take_free_slot() {
    while (!free_slots.empty()) {
        std::ranges::pop_heap(free_slots, std::greater<>{});
        const uint slot = free_slots.back();
        free_slots.pop_back();
        if (slot < slot_count() && uses[slot] == Use::Free) return slot;
    }
    return k_none;
}

void BodyTable::put(uint slot, const BodyDefinition& definition) {
    generations[slot] = next_generations[slot]++;
    const bool rigid = definition.kind == BodyKind::Rigid;
    const auto [mass, inertia] = mass_properties(definition);
    const Material& material = definition.material;
    masses[slot] = rigid ? mass : std::numeric_limits<float>::infinity();
    inertias[slot] = inertia;
    poses[slot] = placed_at(definition.pose);
    velocities[slot] = {to_glm(definition.velocity.linear), rigid ? 1.0f / mass : 0.0f,
                        to_glm(definition.velocity.angular), 0};
    shapes[slot] = pack_shape(definition.shape, definition.kind, definition.sensor);
    properties[slot] = {rigid ? 1.0f / to_glm(inertia) : vec3(0.0f),
                        velocities[slot].inverse_mass,
                        definition.gravity_scale.value_or(rigid ? 1.0f : 0.0f),
                        definition.linear_damping,
                        definition.angular_damping,
                        material.friction,
                        material.restitution,
                        pack_combine(material),
                        0,
                        0};
    loads[slot] = {};
    uses[slot] = Use::Present;
}

void BodyTable::count_body(uint slot, int sign) {
    if (properties[slot].restitution > 0.0f) bouncing_count += sign;
    if (kind_of(slot) == BodyKind::Kinematic) kinematic_count += sign;
    present_count += sign;
}

BodyId BodyTable::add(const BodyDefinition& definition) {
    reserve(1);
    uint slot = take_free_slot();
    if (slot == k_none) {
        slot = slot_count();
        append_slots(1, 1);
    }
    put(slot, definition);
    count_body(slot, 1);
    note_change(slot, k_dirty_all); // and no load; nor has a new body a contact that could last
    return id_of(slot);
}

std::vector<BodyId> BodyTable::add(std::span<const BodyDefinition> definitions, uint threads) {
    const std::size_t count = definitions.size();
    reserve(count, threads);
    std::vector<BodyId> ids;
    reserve_touched(ids, count, threads);
    while (ids.size() < count) {
        const uint slot = take_free_slot();
        if (slot == k_none) break;
        uses[slot] = Use::Present; // the list of free ones may have it twice
        ids.push_back({slot, 0});
    }
    uint next = slot_count();
    try {
        append_slots(count - ids.size(), threads);
    } catch (...) {
        for (const BodyId id : ids) {
            uses[id.index] = Use::Free;
            free_slots.push_back(id.index);
            std::ranges::push_heap(free_slots, std::greater<>{});
        }
        throw;
    }
    while (ids.size() < count)
        ids.push_back({next++, 0});

    in_parts(count, threads, k_many_bodies / 2, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const uint slot = ids[i].index;
            put(slot, definitions[i]);
            ids[i] = id_of(slot);
        }
    });
    for (const BodyId id : ids) {
        count_body(id.index, 1);
        note_change(id.index, k_dirty_all);
    }
    return ids;
}

void BodyTable::remove(BodyId id) {
    const uint slot = id.index;
    count_body(slot, -1);
    shapes[slot].type = k_kind_absent << 8;
    velocities[slot] = {};
    uses[slot] = Use::Resting;
    resting_slots.push_back(slot);
    mark(slot, k_dirty_shape | k_dirty_velocity);
    waking = std::max(waking, Waking::Disturbed);
}

void BodyTable::disturb(uint slot) {
    loads[slot].disturbed = 1;
    mark(slot, k_dirty_load);
    waking = std::max(waking, Waking::Disturbed);
}

void BodyTable::set_sensor(uint slot, bool wanted) {
    shapes[slot].type = wanted ? shapes[slot].type | k_sensor_bit : shapes[slot].type & ~k_sensor_bit;
}

bool BodyTable::contains(BodyId id) const noexcept {
    return id.index < uses.size() && is_present(id.index) && generations[id.index] == id.generation;
}

void BodyTable::recycle() {
    for (const uint slot : resting_slots) {
        uses[slot] = Use::Free;
        free_slots.push_back(slot);
        std::ranges::push_heap(free_slots, std::greater<>{});
    }
    resting_slots.clear();
    while (!uses.empty() && uses.back() == Use::Free)
        drop_last_slot();
}

bool acts(const BodyLoad& load) {
    return load.disturbed != 0 || is_loaded(load);
}

bool BodyTable::has_loads() const {
    return std::ranges::any_of(loaded, [&](uint slot) { return acts(loads[slot]); });
}

void BodyTable::forget_loads() {
    for (const uint slot : loaded)
        loads[slot] = {};
    loaded.clear();
}

void BodyTable::restore(const BodyTable& saved) {
    std::vector<std::uint32_t> newest = std::move(next_generations);
    *this = saved;
    if (newest.size() < next_generations.size()) newest.resize(next_generations.size());
    for (std::size_t slot = 0; slot < next_generations.size(); ++slot)
        newest[slot] = std::max(newest[slot], next_generations[slot]);
    next_generations = std::move(newest);
    loaded.clear();
    for (uint slot = 0; slot < slot_count(); ++slot)
        mark(slot, k_dirty_all); // and not k_dirty_contacts: these last where they would have
    // Where the caller has changed something since the last step.
    const bool disturbed =
        !resting_slots.empty() || std::ranges::any_of(loads, [](const BodyLoad& load) { return load.disturbed != 0; });
    waking = std::max(waking, disturbed ? Waking::Disturbed : Waking::None);
}

std::string BodyTable::complete() {
    const std::size_t slots = poses.size();
    for (const std::size_t size : {velocities.size(), shapes.size(), properties.size(), loads.size(), masses.size(),
                                   inertias.size(), uses.size()})
        if (size != slots) return "its lists of bodies have different lengths";
    if (generations.size() < slots || next_generations.size() < generations.size() || slots > k_most_bodies)
        return "its lists of bodies have wrong lengths";
    dirty.assign(slots, 0);
    changed.clear();
    loaded.clear();
    present_count = bouncing_count = kinematic_count = 0;
    for (uint slot = 0; slot < slots; ++slot) {
        const uint shape = shapes[slot].type & 255u, kind = (shapes[slot].type & ~k_sensor_bit) >> 8;
        if (uses[slot] > Use::Resting || generations[slot] >= next_generations[slot] ||
            (is_present(slot) ? kind > k_kind_kinematic || shape > k_shape_sphere : kind != k_kind_absent))
            return "body " + std::to_string(slot) + " is of no known kind";
        if (is_present(slot)) count_body(slot, 1);
    }
    std::vector<Use> unlisted(uses);
    for (const uint slot : resting_slots) {
        if (slot >= slots || unlisted[slot] != Use::Resting) return "its list of empty places is wrong";
        unlisted[slot] = Use::Free;
    }
    if (std::ranges::count(unlisted, Use::Resting) != 0) return "its list of empty places is too short";
    std::ranges::make_heap(free_slots, std::greater<>{}); // which of its entries are free is seen when one is taken
    return {};
}

void BodyTable::note_change(uint slot, std::uint8_t what) {
    if (dirty[slot] == 0) changed.push_back(slot);
    dirty[slot] |= what;
}

void BodyTable::mark(uint slot, std::uint8_t what) {
    if ((what & k_dirty_load) != 0) loaded.push_back(slot);
    note_change(slot, what);
}

BodyChanges BodyTable::take_changes(bool with_loads, uint threads) {
    TALUS_ASSERT(with_loads || !has_loads(), "a load was given for which no room had been made");
    if (changed.empty()) return {};
    if (!std::ranges::is_sorted(changed)) std::ranges::sort(changed); // neighbours go to neighbouring memory
    const auto take = [&](std::uint8_t what, BufferId buffer, const auto& all) {
        RecordChanges change{buffer, {}, {}};
        const auto count =
            static_cast<std::size_t>(std::ranges::count_if(changed, [&](uint slot) { return is_dirty(slot, what); }));
        if (count == 0) return change;
        reserve_touched(change.slots, count, threads);
        if (!all.empty()) reserve_touched(change.records, count * sizeof(all[0]), threads);
        for (auto next = changed.begin(); next != changed.end();) {
            const uint first = *next;
            uint end = first; // of a run of neighbours
            for (; next != changed.end() && *next == end && is_dirty(end, what); ++next)
                change.slots.push_back(end++);
            if (end == first) ++next;
            if (all.empty()) continue; // the slots say it all
            const auto bytes = std::as_bytes(std::span(all).subspan(first, end - first));
            change.records.insert(change.records.end(), bytes.begin(), bytes.end());
        }
        return change;
    };
    BodyChanges changes(6);
    const std::array<std::function<void()>, 6> tasks{
        [&] { changes[0] = take(k_dirty_pose, BufferId::Poses, poses); },
        [&] { changes[1] = take(k_dirty_velocity, BufferId::Velocities, velocities); },
        [&] { changes[2] = take(k_dirty_shape, BufferId::Shapes, shapes); },
        [&] { changes[3] = take(k_dirty_properties, BufferId::Properties, properties); },
        [&] {
            if (with_loads) changes[4] = take(k_dirty_load, BufferId::Loads, loads);
        },
        [&] { changes[5] = take(k_dirty_contacts, BufferId::Starts, std::span<const BodyStart>()); },
    };
    side_by_side(changed.size() >= k_many_bodies ? threads : 1, tasks);
    std::erase_if(changes, [](const RecordChanges& change) { return change.slots.empty(); });
    for (const uint slot : changed)
        dirty[slot] = 0;
    changed.clear();
    return changes;
}

} // namespace talus::engine
