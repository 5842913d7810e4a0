// SPDX-License-Identifier: MIT
// Records of a body, a manifold or a contact in each lane, cell by cell as state/records.shared.glsl has them.
#pragma once

#include "device/cpu/cpu_state.h"
#include "device/cpu/lane_formulas.h"

namespace talus::engine::TALUS_LANES_NAME {

/// Of what lies one behind the other.
#if TALUS_LANES == 4
constexpr std::uint32_t k_places[k_lanes] = {0, 1, 2, 3};
#else
constexpr std::uint32_t k_places[k_lanes] = {0, 1, 2, 3, 4, 5, 6, 7};
#endif

using BodyOffsets = Offsets<sizeof(engine::BodyVelocity)>; ///< in all arrays of records of this size

TALUS_LANE BodyPose poses_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto position = gather(state.poses.data, bodies, 0);
    return {three_of(position), floatBitsToUint(position.w), all_of(gather(state.poses.data, bodies, 1))};
}

TALUS_LANE void put_poses(const CpuState& state, const std::uint32_t* bodies, std::uint32_t lanes, const BodyPose& p) {
    scatter(state.poses.data, bodies, 0, lanes, {p.position.x, p.position.y, p.position.z, uintBitsToFloat(p.flags)});
    scatter(state.poses.data, bodies, 1, lanes, {p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w});
}

TALUS_LANE void put_starts(const CpuState& state, const std::uint32_t* bodies, std::uint32_t lanes,
                           const BodyStart& s) {
    scatter(state.starts.data, bodies, 0, lanes, {s.position.x, s.position.y, s.position.z, uintBitsToFloat(s.turn)});
}

TALUS_LANE BodyStart starts_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto start = gather(state.starts.data, bodies, 0);
    return {three_of(start), floatBitsToUint(start.w)};
}

TALUS_LANE BodyShape shapes_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto shape = gather(state.shapes.data, bodies, 0);
    return {three_of(shape), floatBitsToUint(shape.w)};
}

template <typename Places> TALUS_LANE BodyVelocity velocities_at(const CpuState& state, const Places& bodies) {
    const auto linear = gather(state.velocities.data, bodies, 0), angular = gather(state.velocities.data, bodies, 1);
    return {three_of(linear), linear.w, three_of(angular), floatBitsToUint(angular.w)};
}

template <typename Places> TALUS_LANE void put_velocities(const CpuState& state, const Places& bodies,
                                                          std::uint32_t lanes, const BodyVelocity& v) {
    const std::uint32_t pushed = lanes & bits_of(v.inverse_mass != 0.0f);
    scatter(state.velocities.data, bodies, 0, pushed, {v.linear.x, v.linear.y, v.linear.z, v.inverse_mass});
    scatter(state.velocities.data, bodies, 1, pushed,
            {v.angular.x, v.angular.y, v.angular.z, uintBitsToFloat(v.stamp)});
}

template <typename Places>
TALUS_LANE void put_deltas(const CpuState& state, const Places& bodies, std::uint32_t lanes, const BodyDelta& d) {
    scatter(state.deltas.data, bodies, 0, lanes, {d.position.x, d.position.y, d.position.z, d.reserved});
    scatter(state.deltas.data, bodies, 1, lanes, {d.rotation.x, d.rotation.y, d.rotation.z, d.rotation.w});
}

TALUS_LANE BodyWarmStart warm_starts_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto a = gather(state.warm_starts.data, bodies, 0), b = gather(state.warm_starts.data, bodies, 1);
    return {three_of(a), a.w, three_of(b), b.w};
}

TALUS_LANE BodyDelta choose(Mask m, const BodyDelta& yes, const BodyDelta& no) {
    return {choose(m, yes.position, no.position), choose(m, yes.reserved, no.reserved),
            choose(m, yes.rotation, no.rotation)};
}

TALUS_LANE void put_warm_starts(const CpuState& state, const std::uint32_t* bodies, std::uint32_t lanes,
                                const BodyWarmStart& w) {
    scatter(state.warm_starts.data, bodies, 0, lanes, {w.linear.x, w.linear.y, w.linear.z, w.reserved_1});
    scatter(state.warm_starts.data, bodies, 1, lanes, {w.angular.x, w.angular.y, w.angular.z, w.reserved_2});
}

/// Behind all warm starts.
TALUS_LANE engine::BodyWarmStart* hits_in(const CpuState& state) {
    return state.warm_starts.data + engine::hits_place(0, state.parameters.body_count);
}

TALUS_LANE BodyProperties properties_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto a = gather(state.properties.data, bodies, 0), b = gather(state.properties.data, bodies, 1),
               c = gather(state.properties.data, bodies, 2);
    return {three_of(a),         a.w, b.x, b.y, b.z, b.w, c.x, floatBitsToUint(c.y), floatBitsToUint(c.z),
            floatBitsToUint(c.w)};
}

TALUS_LANE BodyLoad loads_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto force = gather(state.loads.data, bodies, 0), torque = gather(state.loads.data, bodies, 1);
    return {three_of(force), floatBitsToUint(force.w), three_of(torque), torque.w};
}

template <typename Places> TALUS_LANE BodyDelta deltas_at(const CpuState& state, const Places& bodies) {
    const auto position = gather(state.deltas.data, bodies, 0);
    return {three_of(position), position.w, all_of(gather(state.deltas.data, bodies, 1))};
}

template <typename Places> TALUS_LANE BodyInertia inertias_at(const CpuState& state, const Places& bodies) {
    const auto first = gather(state.inertias.data, bodies, 0), second = gather(state.inertias.data, bodies, 1);
    return {
        first.x, first.y, first.z, first.w, second.x, second.y, floatBitsToUint(second.z), floatBitsToUint(second.w)};
}

TALUS_LANE ContactConstraint constraints_at(const CpuState& state, const std::uint32_t* places) {
    const auto cell = [&](std::size_t i) __attribute__((always_inline)) {
        return gather(state.constraints.data, places, i);
    };
    const auto head = cell(0), normal = cell(1), centre_a = cell(2), centre_b = cell(3), gap = cell(4), mass = cell(5),
               friction = cell(11), slip = cell(12);
    return {floatBitsToUint(head.x),
            floatBitsToUint(head.y),
            floatBitsToUint(head.z),
            floatBitsToUint(head.w),
            three_of(normal),
            normal.w,
            three_of(centre_a),
            centre_a.w,
            three_of(centre_b),
            centre_b.w,
            three_of(gap),
            floatBitsToUint(gap.w),
            three_of(mass),
            mass.w,
            all_of(cell(6)),
            all_of(cell(7)),
            all_of(cell(8)),
            all_of(cell(9)),
            all_of(cell(10)),
            three_of(friction),
            friction.w,
            three_of(slip),
            slip.w,
            all_of(cell(13)),
            all_of(cell(14))};
}
static_assert(offsetof(engine::ContactConstraint, friction_impulse) == engine::k_first_changing * sizeof(Cell) &&
              sizeof(engine::ContactConstraint) == 15 * sizeof(Cell));

/// Writes whole records, whose words are in order.
TALUS_LANE void put_constraints(const CpuState& state, const std::uint32_t* places, std::uint32_t lanes,
                                const ContactConstraint& c) {
    const auto put = [&](std::size_t cell, Lanes x, Lanes y, Lanes z, Lanes w) __attribute__((always_inline)) {
        scatter(state.constraints.data, places, cell, lanes, {x, y, z, w});
    };
    const auto put_3 = [&](std::size_t cell, vec3 v, Lanes w) __attribute__((always_inline)) {
        put(cell, v.x, v.y, v.z, w);
    };
    const auto put_4 = [&](std::size_t cell, vec4 v) __attribute__((always_inline)) {
        put(cell, v.x, v.y, v.z, v.w);
    };
    put(0, uintBitsToFloat(c.body_a), uintBitsToFloat(c.body_b), uintBitsToFloat(c.manifold),
        uintBitsToFloat(c.counts));
    put_3(1, c.normal, c.friction);
    put_3(2, c.centre_a, c.restitution);
    put_3(3, c.centre_b, c.inverse_mass_a);
    put_3(4, c.gap, uintBitsToFloat(c.traits));
    put_3(5, c.friction_mass, c.inverse_mass_b);
    put_4(6, c.x);
    put_4(7, c.y);
    put_4(8, c.lever);
    put_4(9, c.base_separation);
    put_4(10, c.normal_mass);
    put_3(11, c.friction_impulse, c.hub_share);
    put_3(12, c.slip, c.load_speed);
    put_4(13, c.normal_impulse);
    put_4(14, c.total_impulse);
}

// Of this step, or of the last one.
TALUS_LANE Manifold manifolds_at(const engine::Manifold* manifolds, const std::uint32_t* places) {
    const auto cell = [&](std::size_t i) __attribute__((always_inline)) {
        return gather(manifolds, places, i);
    };
    const auto head = cell(0), normal = cell(1), friction = cell(2), rest = cell(3);
    return {floatBitsToUint(head.x),
            floatBitsToUint(head.y),
            floatBitsToUint(head.z),
            floatBitsToUint(head.w),
            three_of(normal),
            floatBitsToUint(normal.w),
            friction.x,
            friction.y,
            friction.z,
            friction.w,
            rest.x,
            rest.y,
            rest.z,
            floatBitsToUint(rest.w)};
}

TALUS_LANE void put_manifolds(const CpuState& state, const std::uint32_t* places, std::uint32_t lanes,
                              const Manifold& m) {
    const auto put = [&](std::size_t cell, FourLanes words) __attribute__((always_inline)) {
        scatter(state.manifolds.data, places, cell, lanes, words);
    };
    put(0, {uintBitsToFloat(m.body_a), uintBitsToFloat(m.body_b), uintBitsToFloat(m.point_count),
            uintBitsToFloat(m.colour)});
    put(1, {m.normal.x, m.normal.y, m.normal.z, uintBitsToFloat(m.axis)});
    put(2, {m.friction, m.restitution, m.tangent_impulse_1, m.tangent_impulse_2});
    put(3, {m.twist_impulse, m.weights, m.lasting_weights, uintBitsToFloat(m.demand)});
}

TALUS_LANE ManifoldPoint points_at(const engine::ManifoldPoint* points, const std::uint32_t* places) {
    const auto point = gather(points, places, 0);
    return {three_of(point), floatBitsToUint(point.w)};
}

TALUS_LANE Separations separations_at(const engine::Separations* separations, const std::uint32_t* places) {
    const auto shift = gather(separations, places, 1);
    return {all_of(gather(separations, places, 0)), three_of(shift), shift.w};
}

TALUS_LANE void put_separations(const CpuState& state, const std::uint32_t* places, std::uint32_t lanes,
                                const Separations& s) {
    scatter(state.point_separations.data, places, 0, lanes,
            {s.separation.x, s.separation.y, s.separation.z, s.separation.w});
    scatter(state.point_separations.data, places, 1, lanes, {s.shift.x, s.shift.y, s.shift.z, s.way});
}

/// As the bodies are now.
TALUS_LANE OrientedBox boxes_now(const CpuState& state, const std::uint32_t* bodies) {
    return make_oriented_box(poses_at(state, bodies), velocities_at(state, bodies), shapes_at(state, bodies),
                             state.parameters);
}

TALUS_LANE OrientedBox oriented_boxes_at(const engine::OrientedBox* boxes, const std::uint32_t* bodies) {
    const auto centre = gather(boxes, bodies, 0), extents = gather(boxes, bodies, 2);
    return {three_of(centre), centre.w, all_of(gather(boxes, bodies, 1)), three_of(extents),
            floatBitsToUint(extents.w)};
}

} // namespace talus::engine::TALUS_LANES_NAME
