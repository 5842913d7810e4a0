// SPDX-License-Identifier: MIT
// One invocation is a body in sorted order: searches the tree for the boxes after its own that overlap it. The way
// through the tree is the sorted order itself, so there is no stack: a node that does not overlap is passed over, one
// that does is entered at its first child. Neighbours in a group take much the same way.
// Run twice: args.x = 0 counts, 1 writes at the scanned offsets. args.y: the root's shift.
// Reads: TreeNodes, TreeGrids, SortValues.
// Writes: PairCounts (counting) or Pairs (writing), in the order of the sort; Counters.
// Needs: a barrier after build_tree; for writing, after the scan of the counts.
// Overflow: the counts' sum is the demand; pairs beyond the capacity are not written. A search that the driver ended is
// told in k_counter_did_not_fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/tree.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer TreeNodes { Aabb tree_nodes[]; };
layout(std430) readonly buffer TreeGrids { TreeGrid tree_grids[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) buffer PairCounts { uint pair_counts[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

void main()
{
    uint own = item_index();
    uint end = tree_grids[0].end;
    if (own >= parameters.body_count) return;
    bool writing = args.x == 1u;
    uint offset = writing ? pair_counts[own] : 0u;
    uint found = 0u;
    uint body = sort_values[own];
    Aabb box = tree_nodes[tree_node(own, 0u, args.y)];
    uint place = own + 1u;
    uint shift = tree_shift_from(place);
    while (place < end) {
        bool overlaps = is_candidate(box, tree_nodes[tree_node(place, shift, args.y)]);
        if (overlaps && shift > 0u) {
            shift -= k_tree_bits;
        } else {
            if (overlaps) {
                uint pair = offset + found;
                if (writing && pair < parameters.pair_capacity) pairs[pair] = make_pair(body, sort_values[place]);
                found += 1u;
            }
            place += 1u << shift;
            shift = tree_shift_from(place);
        }
    }
    if (place < end) atomicOr(counters[k_counter_did_not_fit], k_fit_search);
    if (!writing) pair_counts[own] = found;
}
