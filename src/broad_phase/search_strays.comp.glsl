// SPDX-License-Identifier: MIT
// One invocation is a body slot, and an entry of the list of pairs: which strays the body is near to, and whether the pair is of a
// stray. Of two strays the one with the higher slot finds the pair.
// Reads: Poses, Velocities, Shapes, Strays, StrayMarks, Aabbs, OrientedBoxes, Pairs.
// Writes: KnownPairs and NearPairs, in any order; Counters.
// Needs: a barrier after find_strays.
// Overflow: where strays have too many pairs all are searched for.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 64) in; // k_tile

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Strays { uint strays[]; };
layout(std430) readonly buffer StrayMarks { uint stray_marks[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) writeonly buffer KnownPairs { Pair known_pairs[]; };
layout(std430) writeonly buffer NearPairs { Pair near_pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "broad_phase/box_now.glsl"

const uint k_tile = 64u; // strays that a group has in hand

shared uint stray_count; // 0 where there is nothing to do
shared uint stray_bodies[k_tile];
shared OrientedBox stray_boxes[k_tile];
shared Aabb stray_aabbs[k_tile];

void note_known(Pair pair)
{
    uint place = atomicAdd(counters[k_counter_known_pairs], 1u);
    if (place < most_stray_pairs(parameters.body_count))
        known_pairs[place] = pair;
    else
        counters[k_counter_search_count] = parameters.body_count; // all write the same
}

void note_near(Pair pair)
{
    uint place = atomicAdd(counters[k_counter_near_pairs], 1u);
    if (place < most_stray_pairs(parameters.body_count))
        near_pairs[place] = pair;
    else
        counters[k_counter_search_count] = parameters.body_count;
}

void take_tile(uint first)
{
    uint place = first + gl_LocalInvocationID.x;
    if (place >= stray_count) return;
    stray_bodies[gl_LocalInvocationID.x] = strays[place];
    stray_boxes[gl_LocalInvocationID.x] = box_with_skin(strays[place]);
    stray_aabbs[gl_LocalInvocationID.x] = compute_aabb(stray_boxes[gl_LocalInvocationID.x]);
}

void main()
{
    if (gl_LocalInvocationID.x == 0u)
        stray_count = counters[k_counter_search_count] == 0u ? counters[k_counter_stray_count] : 0u;
    barrier();
    if (stray_count == 0u) return;
    uint item = item_index();
    bool is_body = item < parameters.body_count;
    bool strays_too = is_body && stray_marks[item] != 0u;
    OrientedBox oriented;
    Aabb box;
    if (is_body) {
        if (strays_too)
            oriented = box_with_skin(item);
        else
            oriented = unpack(oriented_boxes[item]);
        if (strays_too)
            box = compute_aabb(oriented);
        else
            box = unpack(aabbs[item]);
    }
    for (uint first = 0u; first < stray_count; first += k_tile) {
        take_tile(first);
        barrier();
        uint in_hand = is_body ? min(stray_count - first, k_tile) : 0u;
        for (uint i = 0u; i < in_hand; ++i) {
            uint stray = stray_bodies[i];
            bool is_its_turn = !strays_too || item > stray;
            if (is_its_turn && is_candidate(stray_aabbs[i], box) && !faces_part(stray_boxes[i], oriented))
                note_near(make_pair(stray, item));
        }
        barrier();
    }
    if (item >= counters[k_counter_pair_demand]) return;
    if (stray_marks[pairs[item].body_a] != 0u || stray_marks[pairs[item].body_b] != 0u) note_known(pairs[item]);
}
