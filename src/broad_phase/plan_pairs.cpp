// SPDX-License-Identifier: MIT
// CPU twin of plan_pairs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void take_pairs(CpuState& state, bool due, bool had_launches) {
    const Array<uint>& counters = state.counters;
    const Parameters& p = state.parameters;
    if (p.body_count == 0) { // nothing has looked at the bodies
        counters[k_counter_pair_demand] = 0;
        counters[k_counter_pairs_changed] = 0;
    }
    if (had_launches) {
        if (due) {
            counters[k_counter_pair_demand] = counters[k_counter_found_pairs];
            counters[k_counter_pairs_changed] = 1;
        }
        counters[k_counter_searched_slots] = p.body_count;
    } else if (due || counters[k_counter_pairs_changed] != 0) {
        counters[k_counter_did_not_fit] |= k_fit_strays;
    }
    if (counters[k_counter_pair_demand] > p.pair_capacity) {
        counters[k_counter_did_not_fit] |= k_fit_pairs;
        counters[k_counter_searched_slots] = k_none; // not all were written
    }
}

static void begin_graph(CpuState& state) {
    for (const uint counter :
         {k_counter_manifold_count, k_counter_contact_count, k_counter_colour_demand, k_counter_overflow_count,
          k_counter_uncoloured, k_counter_hub_count, k_counter_hub_manifolds, k_counter_launched_colours,
          k_counter_launched_substeps, k_counter_launched_overflow, k_counter_sleeping_manifolds, k_counter_singles,
          k_counter_multirate_islands})
        state.counters[counter] = 0;
    state.counters[k_counter_substep_demand] = state.parameters.least_substeps;
}

static void plan_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint>& counters = state.counters;
    const bool due = counters[k_counter_search_count] != 0;
    counters[k_counter_searched] = due ? 1 : 0;
    counters[k_counter_search_count] = 0;
    if (counters[k_counter_did_not_fit] == 0)
        take_pairs(state, due, launch.args[0] == 1);
    else if (due)
        counters[k_counter_searched_slots] = k_none; // the search was not made to its end
    const uint demand = counters[k_counter_pair_demand];
    const uint pair_count = counters[k_counter_did_not_fit] == 0 ? demand : 0;
    counters[k_counter_pair_count] = pair_count;
    if (launch.args[0] == 1) counters[k_counter_graph_due] = 1; // whose pairs may have other numbers
    if (launch.args[1] == 1) begin_graph(state);
    counters[k_counter_report_count] = 0;
    counters[k_counter_sleeping_bodies] = 0;
    counters[k_counter_launched_bodies] = 0;
    state.arrivals[0] = 0;
    state.dispatches[k_dispatch_pairs] = groups_for(pair_count, k_group_size);
    state.dispatches[k_dispatch_pair_tiles] = groups_for(pair_count, k_sort_tile);
    state.dispatches[k_dispatch_old_pairs] = groups_for(counters[k_counter_old_pair_count], k_group_size);
}

const Kernel plan_pairs{"broad_phase/plan_pairs", plan_pairs_on_cpu, 1};

} // namespace talus::engine
