// SPDX-License-Identifier: MIT
// One group: the pairs of strays that are near and not in the list come behind it, in the order of their slots; the strays get the
// boxes that they were searched with.
// Reads: Poses, Velocities, Shapes, Strays, KnownPairs, NearPairs.
// Writes: Pairs, OrientedBoxes, Aabbs, Counters.
// Needs: a barrier after search_strays.
// Overflow: where there is no room for all, the list and the boxes stay as they are, and the step does not fit. So a list is the
// same in however much room.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Strays { uint strays[]; };
layout(std430) readonly buffer KnownPairs { Pair known_pairs[]; };
layout(std430) readonly buffer NearPairs { Pair near_pairs[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };
layout(std430) writeonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) writeonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "broad_phase/box_now.glsl"

shared Pair new_pairs[k_most_stray_pairs]; // in any order
shared uint new_count;

void keep_if_new(Pair pair, uint known_count)
{
    for (uint i = 0u; i < known_count; ++i)
        if (is_same_pair(known_pairs[i], pair)) return;
    new_pairs[atomicAdd(new_count, 1u)] = pair;
}

void add(Pair pair, uint list_count)
{
    uint place = list_count;
    for (uint i = 0u; i < new_count; ++i)
        if (comes_before(new_pairs[i], pair)) place += 1u;
    pairs[place] = pair;
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint stray_count = counters[k_counter_stray_count];
    if (stray_count == 0u || counters[k_counter_search_count] != 0u) return;
    uint list_count = counters[k_counter_pair_demand];
    if (me == 0u) new_count = 0u;
    barrier();
    for (uint i = me; i < counters[k_counter_near_pairs]; i += gl_WorkGroupSize.x)
        keep_if_new(near_pairs[i], counters[k_counter_known_pairs]);
    barrier();
    if (list_count + new_count > parameters.pair_capacity) {
        if (me != 0u) return;
        counters[k_counter_wanted_pairs] = list_count + new_count;
        counters[k_counter_did_not_fit] |= k_fit_pairs;
        return;
    }
    for (uint i = me; i < new_count; i += gl_WorkGroupSize.x)
        add(new_pairs[i], list_count);
    if (me < stray_count) {
        OrientedBox box = box_with_skin(strays[me]);
        oriented_boxes[strays[me]] = pack(box);
        aabbs[strays[me]] = pack(compute_aabb(box));
    }
    if (me != 0u) return;
    counters[k_counter_pair_demand] = list_count + new_count;
    counters[k_counter_added_pairs] += new_count;
}
