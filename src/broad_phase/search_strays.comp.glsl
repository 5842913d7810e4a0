// SPDX-License-Identifier: MIT
// One invocation is a body slot, and an entry of the list of pairs: which strays the body is near to, and whether the pair is of a
// stray. Of two strays the one with the higher slot finds the pair.
// Reads: Poses, Velocities, Shapes, Strays, Aabbs, OrientedBoxes, Pairs.
// Writes: KnownPairs and NearPairs, in any order; Counters.
// Needs: a barrier after find_strays.
// Overflow: where strays have too many pairs all are searched for.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"

layout(local_size_x = 64) in; // at least k_most_strays

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Strays { uint strays[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) writeonly buffer KnownPairs { Pair known_pairs[]; };
layout(std430) writeonly buffer NearPairs { Pair near_pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "broad_phase/box_now.glsl"

shared uint stray_count; // 0 where there is nothing to do
shared uint stray_bodies[k_most_strays];
shared OrientedBox stray_boxes[k_most_strays];
shared Aabb stray_aabbs[k_most_strays];

bool is_stray(uint body)
{
    for (uint i = 0u; i < stray_count; ++i)
        if (stray_bodies[i] == body) return true;
    return false;
}

void note_known(Pair pair)
{
    uint place = atomicAdd(counters[k_counter_known_pairs], 1u);
    if (place < k_most_stray_pairs)
        known_pairs[place] = pair;
    else
        counters[k_counter_search_count] = parameters.body_count; // all write the same
}

void note_near(Pair pair)
{
    uint place = atomicAdd(counters[k_counter_near_pairs], 1u);
    if (place < k_most_stray_pairs)
        near_pairs[place] = pair;
    else
        counters[k_counter_search_count] = parameters.body_count;
}

void find_near(uint body)
{
    bool strays_too = is_stray(body);
    OrientedBox oriented = unpack(oriented_boxes[body]);
    Aabb box = unpack(aabbs[body]);
    if (strays_too) {
        oriented = box_with_skin(body);
        box = compute_aabb(oriented);
    }
    for (uint i = 0u; i < stray_count; ++i) {
        uint stray = stray_bodies[i];
        bool is_its_turn = !strays_too || body > stray;
        if (is_its_turn && is_candidate(stray_aabbs[i], box) && !faces_part(stray_boxes[i], oriented))
            note_near(make_pair(stray, body));
    }
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    if (me == 0u) stray_count = counters[k_counter_search_count] == 0u ? counters[k_counter_stray_count] : 0u;
    barrier();
    if (stray_count == 0u) return;
    if (me < stray_count) {
        stray_bodies[me] = strays[me];
        stray_boxes[me] = box_with_skin(strays[me]);
        stray_aabbs[me] = compute_aabb(stray_boxes[me]);
    }
    barrier();
    uint item = item_index();
    if (item < parameters.body_count) find_near(item);
    if (item >= counters[k_counter_pair_demand]) return;
    if (is_stray(pairs[item].body_a) || is_stray(pairs[item].body_b)) note_known(pairs[item]);
}
