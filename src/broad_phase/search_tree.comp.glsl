// SPDX-License-Identifier: MIT
// One invocation is a body in sorted order: searches the tree for the boxes after its own that overlap it. Those that no face
// keeps apart from it are its partners, in sorted order. A load waits for the one before, so all children of a node are loaded
// at once, and those to be entered are kept as bits: four for each level. Neighbours in a group take much the same way.
// Run twice: args.x = 0 counts, and keeps the first k_kept_partners; 1 writes these at the scanned offset and goes on
// from the last of them if there are more. args.y: the root's shift.
// Reads: Counters, TreeNodes, TreeGrids, SortValues, OrientedBoxes.
// Writes: PairCounts, Partners, which is PairTable (counting), or Pairs (writing), in the order of the sort; Counters.
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
Aabb box; // its own
uint end; // of the bodies that are there

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

// Takes the partners that the counting kept, and returns the last one where the search has to go on behind it, or else the end.
uint take_kept()
{
    uint next = own + 1u < parameters.body_count ? pair_counts[own + 1u] : counters[k_counter_found_pairs];
    uint count = next - offset;
    uint partner = own;
    while (found < min(count, k_kept_partners)) {
        partner = partners[found * parameters.body_count + own];
        take(partner);
    }
    return count > k_kept_partners ? partner : end;
}

// Which of the children of a node, which have that shift, overlap the body's box, of those from one on: a bit for each. All four
// boxes are loaded at once.
uint overlapping_children(uint parent, uint shift, uint from_child)
{
    uint first = parent * k_tree_children;
    uint overlapping = 0u;
    for (uint child = 0u; child < k_tree_children; ++child) {
        uint child_place = (first + child) << shift;
        bool overlaps = is_candidate(box, unpack(tree_nodes[tree_node(child_place, shift, args.y)]));
        if (overlaps && child >= from_child && child_place < end) overlapping |= 1u << child;
    }
    return overlapping;
}

// The children still to be entered: four bits for each level, those of the lowest ones first.
uvec2 pending = uvec2(0u);

void add_pending(uint children, uint shift)
{
    uint bit = shift / k_tree_bits * k_tree_children;
    if (bit < 32u)
        pending.x |= children << bit;
    else
        pending.y |= children << (bit - 32u);
}

uint take_lowest_pending()
{
    uint bit = pending.x != 0u ? uint(findLSB(pending.x)) : 32u + uint(findLSB(pending.y));
    if (pending.x != 0u)
        pending.x &= pending.x - 1u;
    else
        pending.y &= pending.y - 1u;
    return bit;
}

void main()
{
    own = item_index();
    if (own >= counters[k_counter_search_count]) return;
    end = tree_grids[0].end;
    uint last = own; // the place behind which it searches
    body = sort_values[own];
    if (args.x == 1u) {
        offset = pair_counts[own];
        last = take_kept();
        if (last == end) return;
    }
    box = unpack(tree_nodes[tree_node(own, 0u, args.y)]);
    OrientedBox oriented = unpack(oriented_boxes[body]);
    for (uint shift = 0u; shift < args.y; shift += k_tree_bits) { // what follows the place `last` in the nodes around it
        uint around = last >> shift;
        add_pending(overlapping_children(around / k_tree_children, shift, around % k_tree_children + 1u), shift);
    }
    uint place = last; // that the search has come to
    while (pending != uvec2(0u)) {
        uint next = take_lowest_pending();
        uint shift = next / k_tree_children * k_tree_bits;
        uint node = (place >> shift) / k_tree_children * k_tree_children + next % k_tree_children;
        place = node << shift;
        if (shift > 0u)
            add_pending(overlapping_children(node, shift - k_tree_bits, 0u), shift - k_tree_bits);
        else if (!faces_part(oriented, unpack(oriented_boxes[sort_values[place]])))
            take(place);
    }
    if (pending != uvec2(0u)) atomicOr(counters[k_counter_did_not_fit], k_fit_search);
    if (args.x == 0u) pair_counts[own] = found;
}
