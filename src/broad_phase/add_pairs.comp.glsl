// SPDX-License-Identifier: MIT
// One group: the pairs of strays that are near and not in the list come behind it, in the order of their slots; the strays get the
// boxes that they were searched with.
// Reads: Poses, Velocities, Shapes, Strays, KnownPairs, NearPairs.
// Writes: Pairs, OrientedBoxes, Aabbs, Counters.
// Needs: a barrier after search_strays.
// Overflow: where very many are new all are searched for. Where there is no room for all, the list and the boxes stay as they are,
// and the step does not fit. So a list is the same in however much room.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 1024) in;

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

shared Pair new_pairs[k_most_new_pairs]; // in any order
shared uint new_count;
shared Pair known[gl_WorkGroupSize.x]; // a tile of the pairs that are in the list

// Asks about a near pair each; `near_count` of all.
void keep_what_is_new(uint first, uint near_count, uint known_count)
{
    uint me = gl_LocalInvocationID.x;
    bool is_new = first + me < near_count;
    Pair pair = near_pairs[min(first + me, near_count - 1u)];
    for (uint tile = 0u; tile < known_count; tile += gl_WorkGroupSize.x) {
        uint count = min(known_count - tile, gl_WorkGroupSize.x);
        if (me < count) known[me] = known_pairs[tile + me];
        barrier();
        for (uint i = 0u; i < count; ++i)
            is_new = is_new && !is_same_pair(known[i], pair);
        barrier();
    }
    if (!is_new) return;
    uint place = atomicAdd(new_count, 1u);
    if (place < k_most_new_pairs) new_pairs[place] = pair;
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
    uint near_count = counters[k_counter_near_pairs];
    uint known_count = counters[k_counter_known_pairs];
    if (me == 0u) new_count = 0u;
    barrier();
    for (uint first = 0u; first < near_count; first += gl_WorkGroupSize.x)
        keep_what_is_new(first, near_count, known_count);
    barrier();
    if (new_count > k_most_new_pairs) {
        if (me == 0u) counters[k_counter_search_count] = parameters.body_count;
        return;
    }
    if (list_count + new_count > parameters.pair_capacity) {
        if (me != 0u) return;
        counters[k_counter_wanted_pairs] = list_count + new_count;
        counters[k_counter_did_not_fit] |= k_fit_pairs;
        return;
    }
    for (uint i = me; i < new_count; i += gl_WorkGroupSize.x)
        add(new_pairs[i], list_count);
    for (uint i = me; i < stray_count; i += gl_WorkGroupSize.x) {
        OrientedBox box = box_with_skin(strays[i]);
        oriented_boxes[strays[i]] = pack(box);
        aabbs[strays[i]] = pack(compute_aabb(box));
    }
    if (me != 0u) return;
    counters[k_counter_pair_demand] = list_count + new_count;
    counters[k_counter_added_pairs] += new_count;
}
