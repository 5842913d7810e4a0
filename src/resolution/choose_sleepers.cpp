// SPDX-License-Identifier: MIT
// CPU twin of choose_sleepers.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void choose_sleepers_on_cpu(CpuState& state, const Launch& launch) {
    const Parameters& p = state.parameters;
    state.parallel(state.counters[k_counter_graph_bodies], [&](uint body) {
        const uint island = state.islands[body];
        if (island == k_none) return;
        const uint fill = state.island_fill[body], size = state.island_sizes[island];
        const bool is_part = (fill & k_quiet) != 0;
        if (is_part && (fill & k_reached) == 0) {
            state.island_groups[body] = k_kept_island;
            return;
        }
        const IslandAtRest at_rest =
            island_at_rest(size, state.island_starts[island], launch.args[0], launch.args[1] == 1);
        uint own_substeps = state.substeps[body];
        if (at_rest.multirate)
            own_substeps = multirate_substeps(own_substeps, foot_rate_at(state.island_sizes[body]), true, p);
        if (is_part) own_substeps = max(own_substeps, own_substeps_kept(state.rests[body].calm));
        bool awake = (state.island_fill[island] & k_awake) != 0;
        if (at_rest.in_parts) awake = (fill & (k_restless | k_touched)) != 0 || !is_calm(state.rests[body], p);
        const uint substeps = at_rest.multirate ? k_multirate | own_substeps : state.substeps[island];
        const uint kept = at_rest.in_parts ? keep_island(at_rest, own_substeps, state.substeps[island]) : 0;
        state.island_groups[body] = awake ? substeps : is_part ? k_kept_island : kept;
    });
}

const Kernel choose_sleepers{"resolution/choose_sleepers", choose_sleepers_on_cpu};

} // namespace talus::engine
