// SPDX-License-Identifier: MIT
// One invocation is an entry of the list of pairs: whether the pair is one that a stray has been found near to again.
// Reads: Counters, Pairs, StrayMarks, NearTable.
// Writes: NearPairs, those that are in the list.
// Needs: a barrier after compare_strays.
// Overflow: none.
#include "broad_phase/strays.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer StrayMarks { uint stray_marks[]; };
layout(std430) readonly buffer NearTable { uint near_table[]; };
layout(std430) buffer NearPairs { Pair near_pairs[]; };

bool is_near_to_somebody(uint body) { return stray_marks[body] == k_stray_near; }

void main()
{
    if (counters[k_counter_near_pairs] == 0u || counters[k_counter_search_count] != 0u) return;
    uint entry = item_index();
    if (entry >= counters[k_counter_pair_demand]) return;
    Pair pair = pairs[entry];
    if (!is_near_to_somebody(pair.body_a) && !is_near_to_somebody(pair.body_b)) return;
    uint last = near_table_size(parameters.body_count) - 1u;
    uint slot = hash_pair(pair.body_a, pair.body_b) & last;
    uint place = near_table[slot];
    while (place != k_none && !is_same_pair(near_pairs[place], pair)) {
        slot = (slot + 1u) & last;
        place = near_table[slot];
    }
    if (place != k_none) near_pairs[place].body_a = k_none; // is_known: nobody else asks for this one
}
