// SPDX-License-Identifier: MIT
// CPU twin of group_islands.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void group_islands_on_cpu(CpuState& state, const Launch& launch) {
    const Parameters& p = state.parameters;
    uint& launched_substeps = state.counters[k_counter_launched_substeps];
    for (uint body = 0; body < state.counters[k_counter_graph_bodies]; ++body) {
        const uint island = state.islands[body];
        state.island_groups[body] = k_launched;
        state.island_places[body] = k_none;
        if (island == k_none) {
            const bool moves = is_mover(state.shapes[body]) && state.substeps[body] != 0;
            if (moves) launched_substeps = max(launched_substeps, p.least_substeps);
            continue;
        }
        const uint place = state.island_starts[island] + (state.island_fill[island]++ & k_fill_count);
        const uint size = island_size(state.island_sizes[island]);
        const bool multirate = launch.args[3] == 1 ? (state.substeps[body] & k_multirate) != 0 : size >= launch.args[2];
        if (launch.args[0] == 1 && !multirate)
            state.island_groups[body] = island_group(size, state.island_starts[island], launch.args[1] == 1);
        if (body == island && is_single(size) && !multirate) ++state.counters[k_counter_singles];
        state.island_places[body] = place;
        state.island_bodies[place] = body;
        const uint of_island = max(number_of_substeps(state.substeps[island]), p.least_substeps);
        const uint ticks = launch.args[2] != k_none ? doubled_substeps(of_island, p) : of_island;
        if (multirate) {
            if (body == island) ++state.counters[k_counter_multirate_islands];
            const bool tall = (state.island_fill[island] & k_tall) != 0;
            const uint own = multirate_substeps(number_of_substeps(state.substeps[body]),
                                                foot_rate_at(state.island_sizes[body]), tall, p);
            if (body == island && !tall) ++state.counters[k_counter_low_islands];
            // A rate is told a step later.
            state.substeps[body] =
                (body == island ? ticks : min(own, ticks)) | k_multirate | (tall ? k_multirate_tall : 0);
        } else {
            state.substeps[body] = of_island;
        }
        if (state.island_groups[body] == k_launched) launched_substeps = max(launched_substeps, ticks);
    }
}

const Kernel group_islands{"resolution/group_islands", group_islands_on_cpu};

} // namespace talus::engine
