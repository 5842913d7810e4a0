// SPDX-License-Identifier: MIT
// CPU twin of begin_awake.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void begin_awake_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_graph_bodies], [&](uint body) {
        state.island_sizes[body] = state.island_starts[body] = 0;
        if (state.islands[body] != k_none) {
            const uint word = state.island_groups[body];
            const bool in_part = (word & k_kept_island) != 0, awake = word != 0 && !in_part;
            state.substeps[body] = awake ? word : 0;
            state.islands[body] = awake ? body : k_none;
            if (in_part) state.island_sizes[body] = word;
        }
        state.island_fill[body] &= k_touched;
    });
}

const Kernel begin_awake{"resolution/begin_awake", begin_awake_on_cpu};

} // namespace talus::engine
