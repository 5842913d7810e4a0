// SPDX-License-Identifier: MIT
// One group: the pairs of strays that are near and not in the list come behind it, in the order of their slots.
// Reads: Counters, NearPairs.
// Writes: Pairs, Counters.
// Needs: a barrier after find_known_pairs.
// Overflow: where very many are new all are searched for. Where there is no room for all, the list stays as it is, and the step does
// not fit. So a list is the same in however much room.
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 1024) in;

layout(std430) readonly buffer NearPairs { Pair near_pairs[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

shared Pair new_pairs[k_most_new_pairs]; // in any order
shared uint new_count;

void keep_what_is_new(uint near_count)
{
    for (uint i = gl_LocalInvocationID.x; i < near_count; i += gl_WorkGroupSize.x) {
        if (is_known(near_pairs[i])) continue;
        uint place = atomicAdd(new_count, 1u);
        if (place < k_most_new_pairs) new_pairs[place] = near_pairs[i];
    }
}

void add(Pair pair, uint list_count)
{
    uint place = list_count;
    for (uint i = 0u; i < new_count; ++i)
        if (comes_before(new_pairs[i], pair)) place += 1u;
    pairs[place] = pair;
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    if (counters[k_counter_near_pairs] == 0u || counters[k_counter_search_count] != 0u) return;
    uint list_count = counters[k_counter_pair_demand];
    if (me == 0u) new_count = 0u;
    barrier();
    keep_what_is_new(counters[k_counter_near_pairs]);
    barrier();
    if (new_count > k_most_new_pairs) {
        if (me == 0u) counters[k_counter_search_count] = parameters.body_count;
        return;
    }
    if (list_count + new_count > parameters.pair_capacity) {
        if (me != 0u) return;
        counters[k_counter_wanted_pairs] = list_count + new_count;
        counters[k_counter_did_not_fit] |= k_fit_pairs;
        return;
    }
    for (uint i = me; i < new_count; i += gl_WorkGroupSize.x)
        add(new_pairs[i], list_count);
    if (me != 0u) return;
    counters[k_counter_pair_demand] = list_count + new_count;
    counters[k_counter_added_pairs] += new_count;
}
