// SPDX-License-Identifier: MIT
// The end of a step for several bodies side by side: a body in each lane of the CPU's vector registers. With the same
// bits as the formulas for one body.
#pragma once

#include "device/cpu/cpu_state.h"

namespace talus::engine {

/// A body that the step moves, and its flags then, but that k_body_placed is taken off as it moves.
struct MovingBody {
    uint body;
    uint flags;
};

struct LaneMoves {
    uint lanes; ///< bodies side by side
    /// Of as many bodies as there are lanes those in `lanes`, a bit each. Returns those that it has left alone.
    uint (*move_bodies)(const CpuState&, const MovingBody*, uint lanes);
};

/// Moves at most 64 bodies to where the step has taken them, and writes their starts. Returns those that would not be
/// finite there, a bit each: they are left alone.
std::uint64_t move_bodies(const CpuState&, const MovingBody*, uint count);

} // namespace talus::engine
