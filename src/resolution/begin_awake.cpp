// SPDX-License-Identifier: MIT
// CPU twin of begin_awake.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void begin_awake_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_graph_bodies], [&](uint body) {
        if (state.islands[body] != k_none) {
            state.substeps[body] = state.island_groups[body];
            state.islands[body] = state.island_groups[body] != 0 ? body : k_none;
        }
        state.island_sizes[body] = state.island_starts[body] = 0;
        state.island_fill[body] &= k_touched;
        std::fill_n(&state.balances[std::size_t{k_balance_words} * body], k_balance_words, 0u);
    });
}

const Kernel begin_awake{"resolution/begin_awake", begin_awake_on_cpu};

} // namespace talus::engine
