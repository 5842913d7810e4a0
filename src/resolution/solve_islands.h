// SPDX-License-Identifier: MIT
// What the kernels that solve islands in work groups are on the CPU. The GPU's counterpart is solve_in_group.glsl.
#pragma once

#include <algorithm>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// An island, or several, for one thread.
struct IslandWork {
    std::vector<uint> bodies; ///< at least one
    uint first = 0, end = 0;  ///< manifolds, in the order of colours
};

/// All sub-steps. Islands may have different numbers of them.
void solve_island(CpuState& state, const IslandWork&);

void solve_islands_on_cpu(CpuState& state, const Launch& launch);
void solve_island_groups_on_cpu(CpuState& state, const Launch& launch);

} // namespace talus::engine
