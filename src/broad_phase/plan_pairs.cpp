// SPDX-License-Identifier: MIT
// CPU twin of plan_pairs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"
#include "step.h"

namespace talus::engine {

static void take_pairs(CpuState& state, bool due, bool searches_tree, Search launched) {
    const Array<uint>& counters = state.counters;
    const Parameters& p = state.parameters;
    counters[k_counter_wanted_pairs] = 0;
    if (p.body_count == 0) { // nothing has looked at the bodies
        counters[k_counter_pair_demand] = 0;
        counters[k_counter_added_pairs] = 0;
        counters[k_counter_pairs_changed] = 0;
    }
    if (launched == Search::All) {
        if (due) {
            counters[k_counter_pair_demand] = counters[k_counter_found_pairs];
            counters[k_counter_added_pairs] = 0;
            counters[k_counter_pairs_changed] = 1;
        }
        counters[k_counter_searched_slots] = p.body_count;
    } else if (due || searches_tree || counters[k_counter_pairs_changed] != 0) {
        counters[k_counter_did_not_fit] |= k_fit_all;
    }
    if (launched == Search::None && (due || counters[k_counter_stray_count] > 0))
        counters[k_counter_did_not_fit] |= k_fit_strays;
    if (counters[k_counter_pair_demand] > p.pair_capacity) {
        counters[k_counter_did_not_fit] |= k_fit_pairs;
        counters[k_counter_searched_slots] = k_none; // not all were written
    }
    if (counters[k_counter_did_not_fit] != 0) return;
    counters[k_counter_all_strays] = due ? 0 : counters[k_counter_all_strays] + counters[k_counter_stray_count];
}

static void plan_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint>& counters = state.counters;
    const bool due = counters[k_counter_search_count] != 0;
    const bool searches_tree = strays_in_tree(counters[k_counter_stray_count], counters[k_counter_search_count]) > 0;
    counters[k_counter_searched] = due ? 1 : 0;
    counters[k_counter_searched_tree] = searches_tree ? 1 : 0;
    counters[k_counter_strayed] = due || counters[k_counter_stray_count] > 0 ? 1 : 0;
    if (counters[k_counter_did_not_fit] == 0)
        take_pairs(state, due, searches_tree, Search{launch.args[0]});
    else if (due)
        counters[k_counter_searched_slots] = k_none; // the search was not made to its end
    const uint demand = counters[k_counter_pair_demand];
    const uint pair_count = counters[k_counter_did_not_fit] == 0 ? demand : 0;
    counters[k_counter_pair_count] = pair_count;
    const bool other_pairs = counters[k_counter_pairs_changed] != 0;
    const bool may_have_other_shares = launch.args[1] == 1 && counters[k_counter_hub_count] > 0;
    if (other_pairs || launch.args[2] == 1 || (launch.args[2] == 2 && counters[k_counter_awake] != 0))
        counters[k_counter_graph_due] = 1;
    else if (may_have_other_shares && counters[k_counter_graph_due] == 0)
        counters[k_counter_graph_due] = k_due_for_hubs;
    for (const uint counter : {k_counter_search_count, k_counter_stray_count, k_counter_wide_strays,
                               k_counter_near_pairs, k_counter_report_count})
        counters[counter] = 0;
    counters[k_counter_sleeping_bodies] = 0;
    counters[k_counter_launched_bodies] = 0;
    counters[k_counter_pairs_to_collide] = counters[k_counter_awake] = 0;
    state.arrivals[0] = 0;
    state.dispatches[k_dispatch_pairs] = groups_for(pair_count, k_group_size);
    const bool looks_up = other_pairs || launch.args[3] == 1;
    state.dispatches[k_dispatch_table] = groups_for(looks_up ? state.parameters.table_size : 0, k_group_size);
    state.dispatches[k_dispatch_old_pairs] =
        groups_for(looks_up ? counters[k_counter_old_pair_count] : 0, k_group_size);
}

const Kernel plan_pairs{"broad_phase/plan_pairs", plan_pairs_on_cpu, 1};

} // namespace talus::engine
