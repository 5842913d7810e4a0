// SPDX-License-Identifier: MIT
// One group, an invocation for each colour, and in a search for each rate of it: where it begins, and where what has a rate in it ends;
// whether the colours and the sub-steps fit, and the launches of the resolution. args.x: 1 where what is launched has been counted
// apart. args.y: 0 where a work group solves each island, so that colours and sub-steps need no launches; hubs cannot be solved there.
// args.z: 1 where the graph has not been made, as it should be the last step's. args.w: 1 where the overflow set has launches.
// Reads: ManifoldKeys, Counters.
// Writes: ColourOffsets, where the graph is a new one; Counters, Dispatches, Arrivals.
// Needs: a barrier after the sort of the manifolds.
// Overflow: more colours or sub-steps than the host has launches for, and more manifolds, or manifolds of hubs, than it
// has room for, are said in k_counter_did_not_fit, and so is a graph that should have been made. Where that is set, by
// this step or an earlier one, all launches are empty.
#include "state/dispatch.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 384) in; // k_max_colours * k_slownesses

layout(std430) readonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Dispatches { Dispatch dispatches[]; };
layout(std430) writeonly buffer Arrivals { uint arrivals[]; };

shared uint offsets[k_colour_offsets];

// The first manifold with a key or a later one.
uint first_of(uint key)
{
    uint first = 0u;
    uint end = counters[k_counter_graph_pairs];
    while (first < end) {
        uint middle = first + (end - first) / 2u;
        if (manifold_keys[middle] < key)
            first = middle + 1u;
        else
            end = middle;
    }
    return first;
}

// Of the first manifold that a word of ColourOffsets says the place of.
uint key_of_word(uint word, bool apart)
{
    if (word < k_colour_offsets) return first_key(word, apart);
    uint rate = word - k_rate_ends;
    return launched_key(rate % k_max_colours, rate / k_max_colours + 1u);
}

// Of the manifolds that no work group solves. `apart`: they have keys of their own.
void find_offsets(bool is_new, bool apart)
{
    bool has_rates = is_new && counters[k_counter_multirate_islands] != 0u;
    for (uint word = gl_LocalInvocationID.x; word < (has_rates ? k_offset_words : k_colour_offsets); word += gl_WorkGroupSize.x) {
        uint offset = is_new ? first_of(key_of_word(word, apart)) : colour_offsets[word];
        if (word < k_colour_offsets) offsets[word] = offset;
        if (is_new) colour_offsets[word] = offset;
    }
}

void main()
{
    uint colour = gl_LocalInvocationID.x;
    bool measured = args.x == 1u;
    bool launches = args.y == 1u;
    uint colours = counters[measured ? k_counter_launched_colours : k_counter_colour_demand];
    uint substeps = counters[measured ? k_counter_launched_substeps : k_counter_substep_demand];
    uint overflow_count = counters[measured ? k_counter_launched_overflow : k_counter_overflow_count];
    uint did_not_fit = counters[k_counter_did_not_fit];
    bool has_unweighed_hubs = counters[k_counter_hub_count] > 0u && parameters.hub_capacity == 0u;
    uint made_for = counters[k_counter_graph_due];
    bool due = (made_for != 0u && made_for != k_due_for_hubs) || has_unweighed_hubs;
    bool is_new = args.z == 0u && made_for != 0u;
    if (launches) find_offsets(is_new, measured);
    if (args.z == 1u && due) did_not_fit |= k_fit_graph;
    if (launches && (colours > parameters.colour_capacity || (overflow_count > 0u && args.w == 0u)))
        did_not_fit |= k_fit_colours;
    if (launches && substeps > parameters.substep_capacity) did_not_fit |= k_fit_substeps;
    uint awake_count = counters[k_counter_manifold_count]; // of a graph that lasts those that sleep are taken off already
    if (is_new) awake_count -= counters[k_counter_sleeping_manifolds];
    if (awake_count > parameters.manifold_capacity) did_not_fit |= k_fit_manifolds;
    if (counters[k_counter_hub_manifolds] > (launches ? parameters.hub_capacity : 0u)) did_not_fit |= k_fit_hubs;

    uint on = did_not_fit == 0u ? 1u : 0u;
    barrier(); // all have read the counters
    if (colour >= k_max_colours) return;
    uint count = launches ? offsets[colour + 1u] - offsets[colour] : 0u;
    dispatches[k_dispatch_colours + colour] = groups_for(on * count, k_group_size);
    if (colour != 0u) return;
    uint group_count = launches ? count_groups(parameters.body_count) : parameters.body_count;
    dispatches[k_dispatch_bodies] = groups_for(on * max(parameters.body_count, 1u), k_group_size);
    uint ordered_pairs = counters[is_new ? k_counter_graph_pairs : k_counter_ordered_pairs];
    dispatches[k_dispatch_ordered_pairs] = groups_for(on * ordered_pairs, k_group_size);
    dispatches[k_dispatch_islands] = groups_for(on * group_count, 1u);
    dispatches[k_dispatch_overflow] = groups_for(on * min(overflow_count, 1u), 1u);
    dispatches[k_dispatch_hubs] = groups_for(on * counters[k_counter_hub_count], 1u);
    dispatches[k_dispatch_reports] = groups_for(on * counters[k_counter_pair_count], k_group_size);
    dispatches[k_dispatch_report_ends] = groups_for(on * counters[k_counter_old_pair_count], k_group_size);
    counters[k_counter_did_not_fit] = did_not_fit;
    counters[k_counter_manifold_count] = awake_count;
    counters[k_counter_ordered_pairs] = ordered_pairs;
    counters[k_counter_launched_colours] = colours;
    counters[k_counter_launched_substeps] = substeps;
    counters[k_counter_launched_overflow] = overflow_count;
    counters[k_counter_launched_manifolds] = launches ? offsets[k_overflow_colour + 1u] - offsets[0] : 0u;
    arrivals[0] = 0u; // of solve_persistent
    arrivals[k_all_fastest_bodies] = 0u;
    arrivals[k_all_other_fast_bodies] = 0u;
    counters[k_counter_graph_was_due] = due ? 1u : 0u;
    bool is_next_due = on == 0u || made_for == k_due_twice;
    counters[k_counter_graph_due] = is_next_due ? 1u : 0u;
}
