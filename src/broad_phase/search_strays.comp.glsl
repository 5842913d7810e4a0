// SPDX-License-Identifier: MIT
// A group has some strays, and goes down the tree with all of them, level by level: nodes that overlap a stray's box have their children
// looked at in the next level. What was near already as the boxes are that the list was made of is in it, and is not found again.
// Strays that meet too much for that are left to compare_strays.
// args.x: the shift of the nodes that it begins with. args.y: the root's.
// Reads: Counters, Poses, Velocities, Shapes, Strays, TreeNodes, with the strays' boxes as they are now, SortValues, Aabbs,
// OrientedBoxes.
// Writes: NearPairs and NearTable, in any order; StrayMarks, of those that are near to somebody; WideStrays, in any order; Counters.
// Needs: a barrier after build_tree.
// Overflow: where strays are near to too many all are searched for.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/tree.shared.glsl"
#include "broad_phase/strays.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Strays { uint strays[]; };
layout(std430) buffer StrayMarks { uint stray_marks[]; };
layout(std430) readonly buffer TreeNodes { AabbCells tree_nodes[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) writeonly buffer WideStrays { uint wide_strays[]; };
layout(std430) writeonly buffer NearPairs { Pair near_pairs[]; };
layout(std430) buffer NearTable { uint near_table[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "broad_phase/box_now.glsl"
#include "broad_phase/note_near.glsl"

// What a stray meets in a level: the node, and in the highest bits which of the group's strays it is.
const uint k_node_bits = 28u;
const uint k_most_met = 2048u; // in a level

shared Aabb boxes[k_strays_a_group]; // of the strays, as they are now
shared uint met[2u * k_most_met]; // in two levels by turns
shared uint met_counts[3]; // of three: the third is emptied for the next level
shared uint stray_count; // of all groups; 0 where there is nothing to do
shared uint wide; // a bit for each stray that has met more than there is room for

uint first_stray() { return group_index() * k_strays_a_group; }

uint met_count(uint level) { return min(met_counts[level % 3u], k_most_met); }

uint met_in(uint level, uint i) { return met[level % 2u * k_most_met + i]; }

void note_met(uint level, uint stray, uint node)
{
    uint i = atomicAdd(met_counts[level % 3u], 1u);
    if (i < k_most_met)
        met[level % 2u * k_most_met + i] = stray << k_node_bits | node;
    else
        atomicOr(wide, 1u << stray);
}

uint stray_of(uint one) { return one >> k_node_bits; }

uint node_of(uint one) { return one & ((1u << k_node_bits) - 1u); }

void look_at_node(uint level, uint stray, uint node, uint shift)
{
    uint place = node << shift;
    if (place >= parameters.body_count) return;
    if (is_candidate(boxes[stray], unpack(tree_nodes[tree_node(place, shift, args.y)]))) note_met(level, stray, node);
}

// Looks at the children of all that has been met in the level before. `shift`: of the children.
void look_at_level(uint level, uint shift)
{
    for (uint i = gl_LocalInvocationID.x; i < k_tree_children * met_count(level - 1u); i += gl_WorkGroupSize.x) {
        uint parent = met_in(level - 1u, i / k_tree_children);
        look_at_node(level, stray_of(parent), node_of(parent) * k_tree_children + i % k_tree_children, shift);
    }
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    if (me == 0u) { // for all, as another group may find that all are to be searched for
        stray_count = strays_in_tree(counters[k_counter_stray_count], counters[k_counter_search_count]);
        wide = 0u;
    }
    if (me < 2u) met_counts[me] = 0u;
    barrier();
    if (first_stray() >= stray_count) return;
    uint count = min(stray_count - first_stray(), k_strays_a_group);
    if (me < count) boxes[me] = compute_aabb(box_with_skin(strays[first_stray() + me]));
    barrier();
    uint shift = args.x;
    uint first_nodes = tree_level_size(parameters.body_count, shift);
    for (uint i = me; i < count * first_nodes; i += gl_WorkGroupSize.x)
        look_at_node(0u, i / first_nodes, i % first_nodes, shift);
    barrier();
    uint level = 0u;
    for (; shift > 0u; shift -= k_tree_bits) {
        level += 1u;
        if (me == 0u) met_counts[(level + 1u) % 3u] = 0u;
        look_at_level(level, shift - k_tree_bits);
        barrier();
    }
    for (uint i = me; i < met_count(level); i += gl_WorkGroupSize.x) {
        uint leaf = met_in(level, i);
        if ((wide >> stray_of(leaf) & 1u) != 0u) continue;
        uint stray = strays[first_stray() + stray_of(leaf)];
        look_at(stray, box_with_skin(stray), sort_values[node_of(leaf)]);
    }
    if (me < count && (wide >> me & 1u) != 0u)
        wide_strays[atomicAdd(counters[k_counter_wide_strays], 1u)] = strays[first_stray() + me];
}
