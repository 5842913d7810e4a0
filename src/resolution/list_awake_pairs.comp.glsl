// SPDX-License-Identifier: MIT
// One invocation is a pair: where it is marked it comes into the list of those that the constraint graph is made of. The first one also
// plans the launches for these.
// Reads: Marks (scanned), Counters.
// Writes: ManifoldOrder, Counters, Dispatches.
// Needs: a barrier after the scan of the marks.
// Overflow: none.
#include "state/dispatch.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Marks { uint marks[]; };
layout(std430) writeonly buffer ManifoldOrder { uint manifold_order[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Dispatches { Dispatch dispatches[]; };

void main()
{
    uint pair = item_index();
    uint pair_count = counters[k_counter_pair_count];
    uint listed = pair_count > 0u ? counters[k_counter_listed_pairs] : 0u;
    if (pair == 0u) {
        counters[k_counter_graph_pairs] = listed;
        dispatches[k_dispatch_graph_pairs] = groups_for(listed, k_group_size);
        dispatches[k_dispatch_graph_tiles] = groups_for(listed, k_sort_tile);
        dispatches[k_dispatch_graph_counts] = groups_for(listed, k_count_group);
    }
    if (pair >= pair_count) return;
    uint place = marks[pair];
    uint next = pair + 1u < pair_count ? marks[pair + 1u] : listed;
    if (place != next) manifold_order[place] = pair;
}
