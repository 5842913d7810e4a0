// SPDX-License-Identifier: MIT
// CPU twin of measure_islands.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/island_roots.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void stand_for_island(CpuState& state, uint island, uint kept) {
    state.substeps[island] = max(state.substeps[island], substeps_kept(kept));
    state.island_starts[island] |= parts_said(kept);
}

static void measure_islands_on_cpu(CpuState& state, const Launch& launch) {
    const bool asks_who_sleeps = launch.args[0] == 1;
    for (uint body = 0; body < state.counters[k_counter_graph_bodies]; ++body) {
        if (state.islands[body] == k_none) continue;
        const bool is_part = asks_who_sleeps && (state.island_fill[body] & k_quiet) != 0;
        if (is_part && (state.island_fill[body] & k_reached) == 0) continue;
        const uint island = state.islands[body] = root_of(state.islands, body);
        state.substeps[island] = max(state.substeps[island], state.substeps[body]);
        if ((state.island_fill[body] & (k_restless | k_touched)) != 0) state.island_fill[island] |= k_awake;
        state.island_fill[island] |= state.island_fill[body] & k_tall;
        const bool is_hub = state.body_colours[body_word(body, k_hub_word)] != 0;
        state.island_sizes[island] += is_hub ? 1 + k_most_single : 1;
        if (is_part)
            stand_for_island(state, island, state.rests[body].calm);
        else if (!asks_who_sleeps)
            ++state.island_starts[island];
    }
}

const Kernel measure_islands{"resolution/measure_islands", measure_islands_on_cpu};

} // namespace talus::engine
