// SPDX-License-Identifier: MIT
// CPU twin of begin_graph.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void plan_launches(CpuState& state, bool due) {
    const uint pair_count = due ? state.counters[k_counter_pair_count] : 0;
    state.counters[k_counter_graph_bodies] = due ? state.parameters.body_count : 0;
    state.counters[k_counter_graph_pairs] = pair_count;
    state.dispatches[k_dispatch_graph_pairs] = groups_for(pair_count, k_group_size);
    state.dispatches[k_dispatch_graph_tiles] = groups_for(pair_count, k_sort_tile);
    state.dispatches[k_dispatch_graph_counts] = groups_for(pair_count, k_count_group);
}

static void count_nothing(CpuState& state) {
    for (const uint counter :
         {k_counter_manifold_count, k_counter_contact_count, k_counter_colour_demand, k_counter_overflow_count,
          k_counter_uncoloured, k_counter_doubtful, k_counter_given_up, k_counter_hub_count, k_counter_hub_manifolds,
          k_counter_launched_colours, k_counter_launched_substeps, k_counter_launched_overflow,
          k_counter_sleeping_manifolds, k_counter_singles, k_counter_multirate_islands, k_counter_low_islands,
          k_counter_largest_island})
        state.counters[counter] = 0;
    state.counters[k_counter_substep_demand] = state.parameters.least_substeps;
}

static void begin_graph_on_cpu(CpuState& state, const Launch& launch) {
    const Parameters& p = state.parameters;
    const bool due = state.counters[k_counter_graph_due] != 0;
    plan_launches(state, due);
    if (!due) return;
    count_nothing(state);
    std::fill_n(state.body_colours.data, std::size_t{k_body_words} * p.body_count, 0u);
    if (launch.args[0] == 0) return;
    state.parallel(p.body_count, [&](uint body) {
        const BodyShape& shape = state.shapes[body];
        state.islands[body] = is_movable(shape) ? body : k_none;
        state.substeps[body] = p.fewest_substeps;
        state.island_sizes[body] = state.island_starts[body] = 0;
        state.island_fill[body] = 0;
        if (p.rest_steps == 0) return;
        const bool in_parts = launch.args[1] == 1;
        const bool same_pairs = state.counters[k_counter_pairs_changed] == 0; // else what parts stand for is found anew
        const bool part = in_parts && same_pairs && is_quiet_part(state.poses[body]);
        const bool restless = !part && is_restless(state.poses[body], state.velocities[body], shape, p);
        const bool quiet = part || (in_parts && !is_movable(shape) && !restless);
        state.island_fill[body] = (restless ? k_restless : 0) | (quiet ? k_quiet : 0);
    });
}

const Kernel begin_graph{"resolution/begin_graph", begin_graph_on_cpu};

} // namespace talus::engine
