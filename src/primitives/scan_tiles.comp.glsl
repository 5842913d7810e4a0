// SPDX-License-Identifier: MIT
// Last part of a long scan: exclusive prefix sums inside each tile, on top of the sum of all tiles before it.
// One invocation is a run of k_scan_run values; one group is a tile.
// Reads: Values; ScanSums after scan_group; Counters[args.x], from which scan_count(.., args.z, args.w) makes the number.
// Writes: Values, in place.
// Needs: a barrier after scan_group.
// Overflow: none; tiles beyond the number of values write nothing.
#include "primitives/primitives.shared.glsl"
#include "primitives/group_scan.glsl"

layout(local_size_x = 256) in; // k_scan_group

layout(std430) buffer Values { uint values[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer ScanSums { uint scan_sums[]; };

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
    uint before = scan_sums[tile] + group_scan(sum, total);
    for (uint i = first; i < last; ++i) {
        uint value = values[i];
        values[i] = before;
        before += value;
    }
}
