// SPDX-License-Identifier: MIT
// LaneMoves for one set of instructions: src/CMakeLists.txt compiles this once for each.
#include "device/cpu/instruction_set.h"
#include "device/cpu/lane_records.h"
#include "finish/lane_moves.h"

namespace talus::engine::TALUS_LANES_NAME {

inline std::uint32_t move_bodies(const CpuState& state, const MovingBody* moving, std::uint32_t lanes) {
    std::uint32_t bodies[k_lanes];
    for (int lane = 0; lane < k_lanes; ++lane)
        bodies[lane] = moving[lane].body;
    BodyPose pose = poses_at(state, bodies);
    for (int lane = 0; lane < k_lanes; ++lane)
        pose.flags.v[lane] = moving[lane].flags;
    const BodyPose moved = apply_delta(pose, deltas_at(state, bodies));
    const BodyVelocity velocity = velocities_at(state, bodies);
    const std::uint32_t finite = lanes & bits_of(is_finite_motion(moved, velocity));
    put_starts(state, bodies, finite, start_at(pose, moved));
    put_poses(state, bodies, finite, moved);
    put_velocities(state, bodies, finite, limit_speeds(velocity, state.parameters));
    return lanes & ~finite;
}

} // namespace talus::engine::TALUS_LANES_NAME

namespace talus::engine {

extern const LaneMoves TALUS_OF_SET(lane_moves);
const LaneMoves TALUS_OF_SET(lane_moves){TALUS_LANES, TALUS_LANES_NAME::move_bodies};

} // namespace talus::engine
