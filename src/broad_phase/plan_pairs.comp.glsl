// SPDX-License-Identifier: MIT
// One invocation: how many pairs there are, whether they fit, and the launches that treat them.
// args.x: k_search_*, what had launches. args.y: 1 where the constraint graph has them. args.z: 1 where the host knows that it is
// not the last step's, 2 where it is only if nothing is awake. args.w: 1 where the last step's pairs are looked up in any case.
// Reads: Counters.
// Writes: Counters, Dispatches, Arrivals.
// Needs: a barrier after the scan of the pair counts.
// Overflow: says so in k_counter_did_not_fit. Once that is set there are no pairs to treat, in this step and in those
// behind it that are on their way already: the last step's manifolds must be there when the host does it again. So it is
// where a search is due, of all or of the tree for strays, that had no launches.
#include "state/dispatch.shared.glsl"
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 1) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Dispatches { Dispatch dispatches[]; };
layout(std430) writeonly buffer Arrivals { uint arrivals[]; };

void take_pairs(bool due, bool searches_tree)
{
    counters[k_counter_wanted_pairs] = 0u;
    if (parameters.body_count == 0u) { // nothing has looked at the bodies
        counters[k_counter_pair_demand] = 0u;
        counters[k_counter_added_pairs] = 0u;
        counters[k_counter_pairs_changed] = 0u;
    }
    if (args.x == k_search_all) {
        if (due) {
            counters[k_counter_pair_demand] = counters[k_counter_found_pairs];
            counters[k_counter_added_pairs] = 0u;
            counters[k_counter_pairs_changed] = 1u;
        }
        counters[k_counter_searched_slots] = parameters.body_count;
    } else if (due || searches_tree || counters[k_counter_pairs_changed] != 0u) {
        counters[k_counter_did_not_fit] |= k_fit_all;
    }
    if (args.x == k_search_none && (due || counters[k_counter_stray_count] > 0u))
        counters[k_counter_did_not_fit] |= k_fit_strays;
    if (counters[k_counter_pair_demand] > parameters.pair_capacity) {
        counters[k_counter_did_not_fit] |= k_fit_pairs;
        counters[k_counter_searched_slots] = k_none; // not all were written
    }
    if (counters[k_counter_did_not_fit] != 0u) return;
    counters[k_counter_all_strays] = due ? 0u : counters[k_counter_all_strays] + counters[k_counter_stray_count];
}

void main()
{
    bool due = counters[k_counter_search_count] != 0u;
    bool searches_tree = strays_in_tree(counters[k_counter_stray_count], counters[k_counter_search_count]) > 0u;
    counters[k_counter_searched] = due ? 1u : 0u;
    counters[k_counter_searched_tree] = searches_tree ? 1u : 0u;
    counters[k_counter_strayed] = due || counters[k_counter_stray_count] > 0u ? 1u : 0u;
    if (counters[k_counter_did_not_fit] == 0u)
        take_pairs(due, searches_tree);
    else if (due)
        counters[k_counter_searched_slots] = k_none; // the search was not made to its end
    uint demand = counters[k_counter_pair_demand];
    uint pair_count = counters[k_counter_did_not_fit] == 0u ? demand : 0u;
    counters[k_counter_pair_count] = pair_count;
    bool other_pairs = counters[k_counter_pairs_changed] != 0u;
    bool may_have_other_shares = args.y == 1u && counters[k_counter_hub_count] > 0u; // else weigh_hubs knows
    if (other_pairs || args.z == 1u || (args.z == 2u && counters[k_counter_awake] != 0u))
        counters[k_counter_graph_due] = 1u;
    else if (may_have_other_shares && counters[k_counter_graph_due] == 0u)
        counters[k_counter_graph_due] = k_due_for_hubs;
    counters[k_counter_search_count] = 0u;
    counters[k_counter_stray_count] = 0u;
    counters[k_counter_wide_strays] = 0u;
    counters[k_counter_near_pairs] = 0u;
    counters[k_counter_report_count] = 0u;
    counters[k_counter_sleeping_bodies] = 0u;
    counters[k_counter_launched_bodies] = 0u;
    counters[k_counter_pairs_to_collide] = 0u;
    counters[k_counter_awake] = 0u;
    arrivals[0] = 0u; // of the first launch whose groups wait for each other
    dispatches[k_dispatch_pairs] = groups_for(pair_count, k_group_size);
    bool looks_up = other_pairs || args.w == 1u;
    dispatches[k_dispatch_table] = groups_for(looks_up ? parameters.table_size : 0u, k_group_size);
    dispatches[k_dispatch_old_pairs] = groups_for(looks_up ? counters[k_counter_old_pair_count] : 0u, k_group_size);
}
