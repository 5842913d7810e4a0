// SPDX-License-Identifier: MIT
// CPU twin of solve_bouncing_singles.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_islands.h"

namespace talus::engine {

const Kernel solve_bouncing_singles{"resolution/solve_bouncing_singles", solve_single_islands_on_cpu, 1};

} // namespace talus::engine
