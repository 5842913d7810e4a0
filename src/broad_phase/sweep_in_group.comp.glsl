// SPDX-License-Identifier: MIT
// One group does for a small world what two launches of sweep_pairs and the scan between them do for a large one, with
// the same results: all boxes fit into its shared memory.
// One invocation is a body in sorted order, as in sweep_pairs.
// Reads: Counters, SortedAabbs, SweepAxes, SortValues, OrientedBoxes.
// Writes: PairCounts (scanned), Pairs, Counters.
// Needs: a barrier after order_bodies. At most k_island_bodies body slots.
// Overflow: the counts' sum is the demand; pairs beyond the capacity are not written.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 1024) in; // k_island_bodies

layout(std430) readonly buffer SortedAabbs { AabbCells sorted_aabbs[]; };
layout(std430) readonly buffer SweepAxes { SweepAxis sweep_axes[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) writeonly buffer PairCounts { uint pair_counts[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

shared float bounds[6u * k_island_bodies]; // lower x of all boxes, lower y of all, ...
shared uint movable[k_island_bodies / 32u]; // a bit for each place
shared uint sums[k_island_bodies];

void share_box(uint place, Aabb box)
{
    for (uint axis = 0u; axis < 3u; ++axis) {
        bounds[axis * k_island_bodies + place] = component(box.lower, axis);
        bounds[(axis + 3u) * k_island_bodies + place] = component(box.upper, axis);
    }
    if (box.movable != 0u) atomicOr(movable[place / 32u], 1u << (place & 31u));
}

Aabb shared_box(uint place)
{
    Aabb box;
    box.lower = vec3(bounds[place], bounds[k_island_bodies + place], bounds[2u * k_island_bodies + place]);
    box.upper = vec3(bounds[3u * k_island_bodies + place], bounds[4u * k_island_bodies + place],
                     bounds[5u * k_island_bodies + place]);
    box.margin = 0.0;
    box.movable = (movable[place / 32u] >> (place & 31u)) & 1u;
    return box;
}

// How many candidates a body has; with `writing` they go to the places from `offset` on.
uint sweep(uint place, Aabb box, SweepAxis sweep_axis, bool writing, uint offset)
{
    uint found = 0u;
    uint body = sort_values[place];
    OrientedBox oriented = unpack(oriented_boxes[body]);
    float limit = component(box.upper, sweep_axis.axis);
    uint lower = sweep_axis.axis * k_island_bodies;
    bool sweeping = place < sweep_axis.first_large;
    uint i = place + 1u;
    while (i < sweep_axis.end) {
        if (sweeping && (i >= sweep_axis.first_large || bounds[lower + i] > limit)) {
            sweeping = false;
            i = sweep_axis.first_large;
            continue;
        }
        if (is_candidate(box, shared_box(i)) && !faces_part(oriented, unpack(oriented_boxes[sort_values[i]]))) {
            uint pair = offset + found;
            if (writing && pair < parameters.pair_capacity) pairs[pair] = make_pair(body, sort_values[i]);
            found += 1u;
        }
        i += 1u;
    }
    return found;
}

// Sum of `value` over the invocations before this one. Every invocation must call it. As group_scan.glsl, whose two
// rows would not fit beside the boxes: one row, and two barriers a round.
uint sum_before(uint value)
{
    uint me = gl_LocalInvocationID.x;
    uint sum = value;
    sums[me] = sum;
    for (uint reach = 1u; reach < gl_WorkGroupSize.x; reach *= 2u) {
        barrier();
        uint other = me >= reach ? sums[me - reach] : 0u;
        barrier();
        sum += other;
        sums[me] = sum;
    }
    return sum - value;
}

void main()
{
    if (counters[k_counter_search_count] == 0u) return;
    uint me = gl_LocalInvocationID.x;
    bool is_body = me < parameters.body_count;
    SweepAxis sweep_axis = sweep_axes[0];
    if (me < k_island_bodies / 32u) movable[me] = 0u;
    barrier();
    Aabb box;
    if (is_body) {
        box = unpack(sorted_aabbs[me]);
        share_box(me, box);
    }
    barrier();
    uint found = is_body ? sweep(me, box, sweep_axis, false, 0u) : 0u;
    uint offset = sum_before(found);
    if (is_body) {
        pair_counts[me] = offset;
        sweep(me, box, sweep_axis, true, offset);
    }
    if (me == gl_WorkGroupSize.x - 1u) counters[k_counter_found_pairs] = offset + found;
}
