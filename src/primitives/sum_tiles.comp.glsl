// SPDX-License-Identifier: MIT
// First part of a long scan: the sum of each tile.
// One invocation is a run of k_scan_run values; one group is a tile.
// Reads: Values; Counters[args.x], the count from which scan_count(.., args.z, args.w) makes the number of values.
// Writes: ScanSums, one a tile.
// Needs: a barrier before scan_tiles.
// Overflow: none; tiles beyond the number of values write nothing.
#include "primitives/primitives.shared.glsl"
#include "primitives/group_scan.glsl"

layout(local_size_x = 256) in; // k_scan_group

layout(std430) readonly buffer Values { uint values[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) writeonly buffer ScanSums { uint scan_sums[]; };

void main()
{
    uint value_count = scan_count(counters[args.x], args.z, args.w);
    uint tile = group_index();
    if (tile >= divide_up(value_count, k_scan_tile)) return;

    uint first = tile * k_scan_tile + gl_LocalInvocationID.x * k_scan_run;
    uint last = min(first + k_scan_run, value_count);
    uint sum = 0u;
    for (uint i = first; i < last; ++i)
        sum += values[i];

    uint total;
    group_scan(sum, total);
    if (gl_LocalInvocationID.x == 0u) scan_sums[tile] = total;
}
