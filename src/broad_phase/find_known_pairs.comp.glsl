// SPDX-License-Identifier: MIT
// One invocation is an entry of the list of pairs: whether the pair is of a stray that is near to somebody.
// Reads: Counters, Pairs, StrayMarks.
// Writes: KnownPairs, in any order; Counters.
// Needs: a barrier after search_strays.
// Overflow: where strays have too many pairs all are searched for.
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer StrayMarks { uint stray_marks[]; };
layout(std430) writeonly buffer KnownPairs { Pair known_pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

bool is_near_to_somebody(uint body) { return stray_marks[body] == k_stray_near; }

void main()
{
    if (counters[k_counter_near_pairs] == 0u || counters[k_counter_search_count] != 0u) return;
    uint entry = item_index();
    if (entry >= counters[k_counter_pair_demand]) return;
    Pair pair = pairs[entry];
    if (!is_near_to_somebody(pair.body_a) && !is_near_to_somebody(pair.body_b)) return;
    uint place = atomicAdd(counters[k_counter_known_pairs], 1u);
    if (place < most_stray_pairs(parameters.body_count))
        known_pairs[place] = pair;
    else
        counters[k_counter_search_count] = parameters.body_count; // all write the same
}
