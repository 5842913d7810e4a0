// SPDX-License-Identifier: MIT
// One invocation is a body in sorted order: sweeps the bodies after it until their boxes begin beyond its own end, and
// then all large ones (thesis, algorithm 2). The bodies of a group are neighbours in that order and sweep much the same
// boxes, so the group fetches them together, a tile at a time. Run twice: args.x = 0 counts, 1 writes at the scanned
// offsets.
// Reads: Counters, SortedAabbs, SweepAxes, SortValues, OrientedBoxes.
// Writes: PairCounts (counting) or Pairs (writing), in the order of the sort.
// Needs: a barrier after gather_aabbs; for writing, after the scan of the counts.
// Overflow: the counts' sum is the demand; pairs beyond the capacity are not written.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer SortedAabbs { AabbCells sorted_aabbs[]; };
layout(std430) readonly buffer SweepAxes { SweepAxis sweep_axes[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) buffer PairCounts { uint pair_counts[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };

shared Aabb tile[gl_WorkGroupSize.x];
shared bool goes_on;

// This invocation's body.
uint place;
uint body;
Aabb box;
OrientedBox oriented;
uint offset; // of its pairs
uint found = 0u;

void test(uint other, Aabb other_box)
{
    if (!is_candidate(box, other_box) || faces_part(oriented, unpack(oriented_boxes[sort_values[other]]))) return;
    uint pair = offset + found;
    if (args.x == 1u && pair < parameters.pair_capacity) pairs[pair] = make_pair(body, sort_values[other]);
    found += 1u;
}

// Tests those of the places from `first` to `end` that come after the body's own, and stops at the first box that
// begins beyond `limit`. Every invocation must call it.
void sweep(uint first, uint end, uint axis, float limit, bool takes_part)
{
    uint me = gl_LocalInvocationID.x;
    for (uint start = first; start < end; start += gl_WorkGroupSize.x) {
        barrier(); // the last tile has been read
        if (me == 0u) goes_on = false;
        if (start + me < end) tile[me] = unpack(sorted_aabbs[start + me]);
        barrier();
        uint tile_end = min(gl_WorkGroupSize.x, end - start);
        uint i = place >= start ? place - start + 1u : 0u;
        for (; takes_part && i < tile_end; i += 1u) {
            if (component(tile[i].lower, axis) > limit)
                takes_part = false;
            else
                test(start + i, tile[i]);
        }
        if (takes_part) goes_on = true;
        barrier();
        if (!goes_on) break;
    }
}

void main()
{
    if (counters[k_counter_search_count] == 0u) return;
    place = item_index();
    uint group_first = place - gl_LocalInvocationID.x;
    bool is_body = place < parameters.body_count;
    SweepAxis sweep_axis = sweep_axes[0];
    offset = 0u;
    if (is_body) {
        offset = args.x == 1u ? pair_counts[place] : 0u;
        body = sort_values[place];
        box = unpack(sorted_aabbs[place]);
        oriented = unpack(oriented_boxes[body]);
    }
    float limit = component(box.upper, sweep_axis.axis);
    sweep(group_first + 1u, sweep_axis.first_large, sweep_axis.axis, limit, is_body);
    const float everywhere = 3.402823466e38;
    sweep(max(group_first + 1u, sweep_axis.first_large), sweep_axis.end, sweep_axis.axis, everywhere, is_body);
    if (is_body && args.x == 0u) pair_counts[place] = found;
}
