// SPDX-License-Identifier: MIT
// One invocation is a node of the lowest level of this launch; its group makes the four levels above.
// Run once for every four levels. args.x: the lowest level's shift; at 0 its nodes, the leaves, are made first, from
// the bodies in sorted order. args.y: the root's shift. args.z: 1 for a search of strays, for which the bodies are in the order of
// the last search of all, and strays have the boxes that they have now.
// Reads: Counters, Aabbs, SortKeys, SortValues (leaves), StrayMarks, Poses, Velocities, Shapes (of strays); TreeNodes, made by the
// launch before (others).
// Writes: TreeNodes; TreeGrids (end: where the empty body slots begin).
// Needs: a barrier after the sort, and between launches.
// Overflow: none; the host has made room for all levels.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"
#include "broad_phase/curve.shared.glsl"
#include "broad_phase/strays.shared.glsl"
#include "broad_phase/tree.shared.glsl"

layout(local_size_x = 256) in; // k_tree_group

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer StrayMarks { uint stray_marks[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer SortKeys { uint sort_keys[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) buffer TreeNodes { AabbCells tree_nodes[]; };
layout(std430) writeonly buffer TreeGrids { TreeGrid tree_grids[]; };

shared Aabb boxes[k_tree_group];

#include "broad_phase/box_now.glsl"

bool is_for_strays() { return args.z == 1u; }

bool is_wanted()
{
    uint search_count = counters[k_counter_search_count];
    return (is_for_strays() ? strays_in_tree(counters[k_counter_stray_count], search_count) : search_count) > 0u;
}

Aabb box_at(uint place)
{
    uint body = sort_values[place];
    if (is_for_strays() && stray_marks[body] != 0u) return compute_aabb(box_with_skin(body));
    return unpack(aabbs[body]);
}

Aabb make_leaf(uint place)
{
    if (!is_for_strays()) {
        uint key = sort_keys[place];
        uint key_before = place > 0u ? sort_keys[place - 1u] : 0u;
        if (is_first_from(k_absent_key, key, key_before)) tree_grids[0].end = place;
    }
    Aabb box = box_at(place);
    if (!has_room(box)) box = empty_box();
    tree_nodes[tree_node(place, 0u, args.y)] = pack(box);
    return box;
}

void main()
{
    if (!is_wanted()) return;
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
