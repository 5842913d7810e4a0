// SPDX-License-Identifier: MIT
// Last part of a long scan: exclusive prefix sums inside each tile, on top of the sum of all tiles before it.
// One invocation is a run of k_scan_run values; one group is a tile.
// Reads: Values; ScanSums, which each group adds up; Counters[args.x], from which scan_count(.., args.z, args.w) makes the number.
// Writes: Values, in place; their total to Counters[args.y] unless args.y is k_none.
// Needs: a barrier after sum_tiles.
// Overflow: none; tiles beyond the number of values write nothing.
#include "primitives/primitives.shared.glsl"
#include "primitives/group_scan.glsl"

layout(local_size_x = 256) in; // k_scan_group

layout(std430) buffer Values { uint values[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer ScanSums { uint scan_sums[]; };

void main()
{
    uint value_count = scan_count(counters[args.x], args.z, args.w);
    uint tile = group_index();
    uint last_tile = max(divide_up(value_count, k_scan_tile), 1u) - 1u;
    if (tile > last_tile) return;

    uint me = gl_LocalInvocationID.x;
    uint own_sums = 0u; // of this invocation
    for (uint before_it = me; before_it < tile; before_it += k_scan_group)
        own_sums += scan_sums[before_it];
    uint sum_of_tiles;
    group_scan(own_sums, sum_of_tiles);

    uint first = tile * k_scan_tile + me * k_scan_run;
    uint last = min(first + k_scan_run, value_count);
    uint sum = 0u;
    for (uint i = first; i < last; ++i)
        sum += values[i];

    uint total;
    uint before = sum_of_tiles + group_scan(sum, total);
    for (uint i = first; i < last; ++i) {
        uint value = values[i];
        values[i] = before;
        before += value;
    }
    if (tile == last_tile && me == 0u && args.y != k_none) counters[args.y] = sum_of_tiles + total;
}
