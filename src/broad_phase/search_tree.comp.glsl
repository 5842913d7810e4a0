// SPDX-License-Identifier: MIT
// One invocation is a body in sorted order: searches the tree for the boxes after its own that overlap it. Those that no face
// keeps apart from it are its partners. The way through the tree is the sorted order itself, so there is no stack: a node
// that does not overlap is passed over, one that does is entered at its first child. Neighbours in a group take much the
// same way.
// Run twice: args.x = 0 counts, and keeps the first k_kept_partners; 1 writes these at the scanned offset and goes on
// from the last of them if there are more. args.y: the root's shift.
// Reads: Counters, TreeNodes, TreeGrids, SortValues, OrientedBoxes.
// Writes: PairCounts, Partners (counting) or Pairs (writing), in the order of the sort; Counters.
// Needs: a barrier after build_tree; for writing, after the scan of the counts.
// Overflow: the counts' sum is the demand; pairs beyond the capacity are not written. A search that the driver ended is
// told in k_counter_did_not_fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/tree.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer TreeNodes { AabbCells tree_nodes[]; };
layout(std430) readonly buffer TreeGrids { TreeGrid tree_grids[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) buffer PairCounts { uint pair_counts[]; };
layout(std430) buffer Partners { uint partners[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

uint own; // place of this invocation's body
uint body;
uint offset = 0u; // of its pairs
uint found = 0u;

void take(uint partner)
{
    uint pair = offset + found;
    uint kept = found * parameters.body_count + own;
    if (args.x == 1u) {
        if (pair < parameters.pair_capacity) pairs[pair] = make_pair(body, sort_values[partner]);
    } else if (found < k_kept_partners) {
        partners[kept] = partner;
    }
    found += 1u;
}

// Takes the partners that the counting kept, and returns the place from which on the search has to go.
uint take_kept(uint end)
{
    uint next = own + 1u < parameters.body_count ? pair_counts[own + 1u] : counters[k_counter_found_pairs];
    uint count = next - offset;
    uint partner = own;
    while (found < min(count, k_kept_partners)) {
        partner = partners[found * parameters.body_count + own];
        take(partner);
    }
    return count > k_kept_partners ? partner + 1u : end;
}

void main()
{
    own = item_index();
    if (own >= counters[k_counter_search_count]) return;
    uint end = tree_grids[0].end;
    uint place = own + 1u;
    body = sort_values[own];
    if (args.x == 1u) {
        offset = pair_counts[own];
        place = take_kept(end);
        if (place >= end) return;
    }
    Aabb box = unpack(tree_nodes[tree_node(own, 0u, args.y)]);
    OrientedBox oriented = unpack(oriented_boxes[body]);
    uint shift = tree_shift_from(place);
    while (place < end) {
        bool overlaps = is_candidate(box, unpack(tree_nodes[tree_node(place, shift, args.y)]));
        if (overlaps && shift > 0u) {
            shift -= k_tree_bits;
        } else {
            if (overlaps && !faces_part(oriented, unpack(oriented_boxes[sort_values[place]]))) take(place);
            place += 1u << shift;
            shift = tree_shift_from(place);
        }
    }
    if (place < end) atomicOr(counters[k_counter_did_not_fit], k_fit_search);
    if (args.x == 0u) pair_counts[own] = found;
}
