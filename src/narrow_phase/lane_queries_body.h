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

TALUS_LANE Aabb aabbs_now(const CpuState& state, const std::uint32_t* bodies) {
    const auto linear = gather(state.velocities.data, bodies, 0);
    BodyVelocity velocity; // what a box asks for
    velocity.linear = three_of(linear);
    return compute_aabb(
        make_oriented_box(poses_at(state, bodies), velocity, shapes_at(state, bodies), state.parameters));
}

inline std::uint32_t find_near(const CpuState& state, const engine::Pair* pairs) {
    std::uint32_t body_a[k_lanes], body_b[k_lanes];
    for (int lane = 0; lane < k_lanes; ++lane) {
        body_a[lane] = pairs[lane].body_a;
        body_b[lane] = pairs[lane].body_b;
    }
    return bits_of(is_candidate(aabbs_now(state, body_a), aabbs_now(state, body_b)));
}

inline void query_axes(const CpuState& state, const AxisQuestion* questions, engine::AxisQuery* answers) {
    std::uint32_t body_a[k_lanes], body_b[k_lanes];
    UintVector old_axes{};
    for (int lane = 0; lane < k_lanes; ++lane) {
        body_a[lane] = questions[lane].body_a;
        body_b[lane] = questions[lane].body_b;
        old_axes[lane] = questions[lane].old_axis;
    }
    const BoxPair boxes = make_box_pair(poses_at(state, body_a), shapes_at(state, body_a), poses_at(state, body_b),
                                        shapes_at(state, body_b));
    const AxisQuery best = query_axes(boxes, ULanes(old_axes));
    for (int lane = 0; lane < k_lanes; ++lane)
        answers[lane] = {best.separation.v[lane], best.score.v[lane], best.axis.v[lane]};
}

} // namespace talus::engine::TALUS_LANES_NAME
