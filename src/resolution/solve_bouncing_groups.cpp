// SPDX-License-Identifier: MIT
// CPU twin of solve_bouncing_groups.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_islands.h"

namespace talus::engine {

const Kernel solve_bouncing_groups{"resolution/solve_bouncing_groups", solve_island_groups_on_cpu, 1};

} // namespace talus::engine
