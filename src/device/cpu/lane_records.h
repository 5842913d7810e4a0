// SPDX-License-Identifier: MIT
// Records of a body in each lane, cell by cell as state/records.shared.glsl has them.
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

TALUS_LANE BodyPose poses_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto position = gather(state.poses.data, bodies, 0);
    return {three_of(position), floatBitsToUint(position.w), all_of(gather(state.poses.data, bodies, 1))};
}

TALUS_LANE BodyVelocity velocities_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto linear = gather(state.velocities.data, bodies, 0), angular = gather(state.velocities.data, bodies, 1);
    return {three_of(linear), linear.w, three_of(angular), floatBitsToUint(angular.w)};
}

TALUS_LANE BodyShape shapes_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto shape = gather(state.shapes.data, bodies, 0);
    return {three_of(shape), floatBitsToUint(shape.w)};
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
