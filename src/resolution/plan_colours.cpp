// SPDX-License-Identifier: MIT
// CPU twin of plan_colours.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

/// Where each colour begins, and what has a rate in it ends, of the manifolds that no work group solves. `apart`: they
/// have keys of their own.
static void find_offsets(CpuState& state, bool apart) {
    const uint *keys = state.manifold_keys.data, *end = keys + state.counters[k_counter_graph_pairs];
    const auto first_of = [&](uint key) { return static_cast<uint>(std::lower_bound(keys, end, key) - keys); };
    for (uint colour = 0; colour < k_colour_offsets; ++colour)
        state.colour_offsets[colour] = first_of(first_key(colour, apart));
    if (state.counters[k_counter_multirate_islands] == 0) return;
    for (uint colour = 0; colour < k_max_colours; ++colour)
        for (uint r = 0; r < k_most_doublings; ++r)
            state.colour_offsets[rate_end_word(colour, r)] = first_of(launched_key(colour, r + 1));
}

static void plan_colours_on_cpu(CpuState& state, const Launch& launch) {
    const bool measured = launch.args[0] == 1, launches = launch.args[1] == 1;
    const Array<uint>& offsets = state.colour_offsets;
    const Array<uint>& counters = state.counters;
    const Parameters& p = state.parameters;
    uint& did_not_fit = counters[k_counter_did_not_fit];
    const bool has_unweighed_hubs = counters[k_counter_hub_count] > 0 && p.hub_capacity == 0;
    const uint made_for = counters[k_counter_graph_due];
    const bool due = (made_for != 0 && made_for != k_due_for_hubs) || has_unweighed_hubs;
    const bool is_new = launch.args[2] == 0 && made_for != 0;
    if (launches && is_new) find_offsets(state, measured);
    if (launch.args[2] == 1 && due) did_not_fit |= k_fit_graph;
    const uint colours = counters[measured ? k_counter_launched_colours : k_counter_colour_demand];
    const uint substeps = counters[measured ? k_counter_launched_substeps : k_counter_substep_demand];
    const uint overflow_count = counters[measured ? k_counter_launched_overflow : k_counter_overflow_count];
    if (launches && (colours > p.colour_capacity || (overflow_count > 0 && launch.args[3] == 0)))
        did_not_fit |= k_fit_colours;
    if (launches && substeps > p.substep_capacity) did_not_fit |= k_fit_substeps;
    if (is_new) counters[k_counter_manifold_count] -= counters[k_counter_sleeping_manifolds];
    if (counters[k_counter_manifold_count] > p.manifold_capacity) did_not_fit |= k_fit_manifolds;
    if (counters[k_counter_hub_manifolds] > (launches ? p.hub_capacity : 0)) did_not_fit |= k_fit_hubs;

    const uint on = did_not_fit == 0 ? 1 : 0;
    const uint group_count = launches ? count_groups(p.body_count) : p.body_count;
    state.dispatches[k_dispatch_bodies] = groups_for(on * max(p.body_count, 1u), k_group_size);
    if (is_new) counters[k_counter_ordered_pairs] = counters[k_counter_graph_pairs];
    state.dispatches[k_dispatch_ordered_pairs] = groups_for(on * counters[k_counter_ordered_pairs], k_group_size);
    state.dispatches[k_dispatch_islands] = groups_for(on * group_count, 1);
    for (uint colour = 0; colour < k_max_colours; ++colour) {
        const uint count = launches ? offsets[colour + 1] - offsets[colour] : 0;
        state.dispatches[k_dispatch_colours + colour] = groups_for(on * count, k_group_size);
    }
    state.dispatches[k_dispatch_overflow] = groups_for(on * min(overflow_count, 1u), 1);
    state.dispatches[k_dispatch_hubs] = groups_for(on * counters[k_counter_hub_count], 1);
    counters[k_counter_launched_colours] = colours;
    counters[k_counter_launched_substeps] = substeps;
    counters[k_counter_launched_overflow] = overflow_count;
    counters[k_counter_launched_manifolds] = launches ? offsets[k_overflow_colour + 1] - offsets[0] : 0;
    state.arrivals[0] = 0;
    state.arrivals[k_all_fastest_bodies] = 0;
    state.arrivals[k_all_other_fast_bodies] = 0;
    counters[k_counter_graph_was_due] = due ? 1 : 0;
    const bool is_next_due = on == 0 || made_for == k_due_twice;
    counters[k_counter_graph_due] = is_next_due ? 1 : 0;
    state.dispatches[k_dispatch_reports] = groups_for(on * counters[k_counter_pair_count], k_group_size);
    state.dispatches[k_dispatch_report_ends] = groups_for(on * counters[k_counter_old_pair_count], k_group_size);
}

const Kernel plan_colours{"resolution/plan_colours", plan_colours_on_cpu, 1};

} // namespace talus::engine
