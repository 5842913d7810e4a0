// SPDX-License-Identifier: MIT
// One invocation is a word of marks, of 32 pairs: those that are marked come into the list of those that the constraint graph is made of.
// The first one also plans the launches for these.
// Reads: Marks, MarkCounts (scanned), Counters.
// Writes: ListedPairs, Counters, Dispatches.
// Needs: a barrier after the scan of the counts.
// Overflow: none.
#include "state/dispatch.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer MarkCounts { uint mark_counts[]; };
layout(std430) readonly buffer Marks { uint marks[]; };
layout(std430) writeonly buffer ListedPairs { uint listed_pairs[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Dispatches { Dispatch dispatches[]; };

void main()
{
    uint word = item_index();
    uint pair_count = counters[k_counter_pair_count];
    uint listed = pair_count > 0u ? counters[k_counter_listed_pairs] : 0u;
    if (word == 0u) {
        counters[k_counter_graph_pairs] = listed;
        dispatches[k_dispatch_graph_pairs] = groups_for(listed, k_group_size);
        dispatches[k_dispatch_graph_tiles] = groups_for(listed, k_sort_tile);
        dispatches[k_dispatch_graph_counts] = groups_for(listed, k_count_group);
    }
    if (listed == 0u || 32u * word >= pair_count) return;
    uint group = word / k_mark_words;
    uint place = mark_counts[group];
    for (uint before = k_mark_words * group; before < word; ++before)
        place += uint(bitCount(marks[before]));
    for (uint left = marks[word]; left != 0u; left &= left - 1u)
        listed_pairs[place++] = 32u * word + uint(findLSB(left));
}
