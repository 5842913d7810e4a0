// SPDX-License-Identifier: MIT
#include "finish/lane_moves.h"

#include "device/cpu/by_lanes.h"

namespace talus::engine {

TALUS_DECLARE_OF_SETS(LaneMoves, lane_moves);

std::uint64_t move_bodies(const CpuState& state, const MovingBody* bodies, uint count) {
    const LaneMoves& moves = TALUS_FOR_THIS_MACHINE(lane_moves);
    std::uint64_t left_alone = 0;
    by_lanes(moves.lanes, bodies, count, [&](uint done, const MovingBody* some, uint active) {
        left_alone |= std::uint64_t{moves.move_bodies(state, some, active)} << done;
    });
    return left_alone;
}

} // namespace talus::engine
