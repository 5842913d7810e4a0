// SPDX-License-Identifier: MIT
// One group does for a small world what update_aabbs, measure_spread, choose_axis, write_sort_keys, the sort and gather_aabbs do
// for a large one, with the same results: six dispatches that wait for each other become one.
// Reads: Counters, Poses, Velocities, Shapes.
// Writes: OrientedBoxes, Aabbs, SpreadSums, SweepAxes, SortKeys, SortValues, SortedAabbs.
// Needs: a barrier after find_strays. At most k_island_bodies body slots.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"
#include "primitives/primitives.shared.glsl"

layout(local_size_x = 512) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) writeonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) coherent buffer Aabbs { AabbCells aabbs[]; };
layout(std430) writeonly buffer SpreadSums { SpreadSum spread_sums[]; };
layout(std430) writeonly buffer SweepAxes { SweepAxis sweep_axes[]; };
layout(std430) writeonly buffer SortKeys { uint sort_keys[]; };
layout(std430) writeonly buffer SortValues { uint sort_values[]; };
layout(std430) writeonly buffer SortedAabbs { AabbCells sorted_aabbs[]; };

#include "primitives/group_sort.glsl"

const uint k_spread_groups = k_island_bodies / k_spread_group; // 4

shared SpreadSum sums[k_spread_group];
shared SpreadSum group_sums[k_spread_groups];
shared SweepAxis sweep_axis;

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
Aabb load_aabb(uint body)
{
    AabbCells box = aabbs[body];
    return unpack(box);
}

#include "broad_phase/box_now.glsl"

// A tree for each k_spread_group bodies, as in measure_spread, and one over their sums, as in choose_axis. What it
// returns is right for the first invocation.
SpreadSum measure_spread()
{
    uint me = gl_LocalInvocationID.x;
    for (uint group = 0u; me == 0u && group < k_spread_groups; ++group)
        group_sums[group] = empty_spread();
    for (uint first = 0u; first < parameters.body_count; first += k_spread_group) {
        uint body = first + me;
        if (me < k_spread_group) {
            sums[me] = empty_spread();
            if (body < parameters.body_count) {
                sums[me] = spread_of(load_aabb(body));
            }
        }
        for (uint half_size = k_spread_group / 2u; half_size > 0u; half_size /= 2u) {
            barrier();
            if (me < half_size) sums[me] = add_spreads(sums[me], sums[me + half_size]);
        }
        if (me == 0u) {
            spread_sums[first / k_spread_group] = sums[0];
            group_sums[first / k_spread_group] = sums[0];
        }
        barrier();
    }
    return add_spreads(add_spreads(group_sums[0], group_sums[2]), add_spreads(group_sums[1], group_sums[3]));
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint body_count = parameters.body_count;
    if (counters[k_counter_search_count] == 0u) return;
    for (uint body = me; body < body_count; body += gl_WorkGroupSize.x) {
        OrientedBox box = box_with_skin(body);
        oriented_boxes[body] = pack(box);
        aabbs[body] = pack(compute_aabb(box));
    }
    groupMemoryBarrier();
    barrier();
    SpreadSum sum = measure_spread();
    if (me == 0u) sweep_axis = choose_sweep_axis(sum, body_count);
    barrier();

    uint room = sort_room(body_count);
    for (uint place = me; place < room; place += gl_WorkGroupSize.x) {
        sorted_keys[place] = 0xffffffffu;
        if (place < body_count) {
            sorted_keys[place] = sweep_key(load_aabb(place), sweep_axis);
        }
        old_places[place] = place;
    }
    barrier();
    sort_group(room);

    for (uint place = me; place < body_count; place += gl_WorkGroupSize.x) {
        uint key = sorted_keys[place];
        uint key_before = place > 0u ? sorted_keys[place - 1u] : 0u;
        if (is_first_from(k_large_key, key, key_before)) sweep_axis.first_large = place;
        if (is_first_from(k_absent_key, key, key_before)) sweep_axis.end = place;
        sorted_aabbs[place] = aabbs[old_places[place]];
        sort_keys[place] = key;
        sort_values[place] = old_places[place];
    }
    barrier();
    if (me == 0u) sweep_axes[0] = sweep_axis;
}
