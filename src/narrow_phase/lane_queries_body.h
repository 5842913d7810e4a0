// SPDX-License-Identifier: MIT
// LaneQueries for one set of instructions. Included once by each lane_queries_*.cpp.
#pragma once

#include "device/cpu/lane_formulas.h"
#include "narrow_phase/lane_queries.h"

namespace talus::engine::TALUS_LANES_NAME {

TALUS_LANE BodyPose poses_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto position = gather(state.poses.data, bodies, 0);
    return {three_of(position), floatBitsToUint(position.w), all_of(gather(state.poses.data, bodies, 1))};
}

TALUS_LANE BodyShape shapes_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto shape = gather(state.shapes.data, bodies, 0);
    return {three_of(shape), floatBitsToUint(shape.w)};
}

/// Of a Pair or an AxisQuestion in each lane.
struct BodiesOfPairs {
    std::uint32_t a[k_lanes], b[k_lanes];
};

template <typename Item> TALUS_LANE BodiesOfPairs bodies_of(const Item* items) {
    BodiesOfPairs bodies;
    for (int lane = 0; lane < k_lanes; ++lane) {
        bodies.a[lane] = items[lane].body_a;
        bodies.b[lane] = items[lane].body_b;
    }
    return bodies;
}

TALUS_LANE Aabb aabbs_now(const CpuState& state, const std::uint32_t* bodies) {
    BodyVelocity velocity;
    velocity.linear = three_of(gather(state.velocities.data, bodies, 0)); // all of it that a box asks for
    return compute_aabb(
        make_oriented_box(poses_at(state, bodies), velocity, shapes_at(state, bodies), state.parameters));
}

inline NearPairs find_near(const CpuState& state, const engine::Pair* pairs) {
    const BodiesOfPairs bodies = bodies_of(pairs);
    const Aabb a = aabbs_now(state, bodies.a), b = aabbs_now(state, bodies.b);
    return {bits_of(is_candidate(a, b)), bits_of(is_still_candidate(a, b))};
}

inline void query_axes(const CpuState& state, const AxisQuestion* questions, engine::AxisQuery* answers) {
    const BodiesOfPairs bodies = bodies_of(questions);
    UintVector old_axes{};
    for (int lane = 0; lane < k_lanes; ++lane)
        old_axes[lane] = questions[lane].old_axis;
    const BoxPair boxes = make_box_pair(poses_at(state, bodies.a), shapes_at(state, bodies.a),
                                        poses_at(state, bodies.b), shapes_at(state, bodies.b));
    const AxisQuery best = query_axes(boxes, ULanes(old_axes));
    for (int lane = 0; lane < k_lanes; ++lane)
        answers[lane] = {best.separation.v[lane], best.score.v[lane], best.axis.v[lane]};
}

} // namespace talus::engine::TALUS_LANES_NAME
