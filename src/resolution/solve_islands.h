// SPDX-License-Identifier: MIT
// What solve_islands and solve_bouncing_islands are on the CPU. The GPU's counterpart is solve_islands.glsl.
#pragma once

#include "device/cpu/cpu_state.h"

namespace talus::engine {

void solve_islands_on_cpu(CpuState& state, const Launch& launch);

} // namespace talus::engine
