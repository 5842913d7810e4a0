// SPDX-License-Identifier: MIT
// One invocation is a node of the lowest level of this launch; its group makes the four levels above.
// Run once for every four levels. args.x: the lowest level's shift; at 0 its nodes, the leaves, are made first, from
// the bodies in sorted order. args.y: the root's shift.
// Reads: Counters, Aabbs, SortKeys, SortValues (leaves); TreeNodes, made by the launch before (others).
// Writes: TreeNodes; TreeGrids (end: where the empty body slots begin).
// Needs: a barrier after the sort, and between launches.
// Overflow: none; the host has made room for all levels.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"
#include "broad_phase/curve.shared.glsl"
#include "broad_phase/tree.shared.glsl"

layout(local_size_x = 256) in; // k_tree_group

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer SortKeys { uint sort_keys[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) buffer TreeNodes { AabbCells tree_nodes[]; };
layout(std430) writeonly buffer TreeGrids { TreeGrid tree_grids[]; };

shared Aabb boxes[k_tree_group];

Aabb make_leaf(uint place)
{
    uint key = sort_keys[place];
    uint key_before = place > 0u ? sort_keys[place - 1u] : 0u;
    if (is_first_from(k_absent_key, key, key_before)) tree_grids[0].end = place;
    Aabb box = empty_box();
    if (key != k_absent_key) box = unpack(aabbs[sort_values[place]]);
    tree_nodes[tree_node(place, 0u, args.y)] = pack(box);
    return box;
}

void main()
{
    if (counters[k_counter_search_count] == 0u) return;
    uint me = gl_LocalInvocationID.x;
    uint shift = args.x;
    uint node = item_index();
    Aabb box = empty_box();
    if (node < tree_level_size(parameters.body_count, shift)) {
        if (shift == 0u)
            box = make_leaf(node);
        else
            box = unpack(tree_nodes[tree_node(node << shift, shift, args.y)]);
    }
    boxes[me] = box;
    for (uint size = k_tree_group >> k_tree_bits; size > 0u && shift < args.y; size >>= k_tree_bits) {
        shift += k_tree_bits;
        barrier();
        if (me < size) {
            box = boxes[4u * me];
            for (uint child = 1u; child < 4u; ++child)
                box = unite_boxes(box, boxes[4u * me + child]);
        }
        barrier();
        node = group_index() * size + me;
        if (me < size) boxes[me] = box;
        if (me < size && node < tree_level_size(parameters.body_count, shift))
            tree_nodes[tree_node(node << shift, shift, args.y)] = pack(box);
    }
}
