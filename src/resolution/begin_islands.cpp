// SPDX-License-Identifier: MIT
// CPU twin of begin_islands.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void begin_islands_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.parameters.body_count, [&](uint body) {
        state.islands[body] = is_movable(state.shapes[body]) ? body : k_none;
        state.substeps[body] = state.parameters.least_substeps;
        state.island_sizes[body] = state.island_starts[body] = state.island_fill[body] = 0;
    });
}

const Kernel begin_islands{"resolution/begin_islands", begin_islands_on_cpu};

} // namespace talus::engine
