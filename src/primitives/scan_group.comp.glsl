// SPDX-License-Identifier: MIT
// Exclusive prefix sums by a single work group, tile after tile.
// One invocation is a run of k_scan_run values of each tile; launched as one group.
// Reads: Values; Counters[args.x], the count from which scan_count(.., args.z, args.w) makes the number of values.
// Writes: Values, in place; their total to Counters[args.y] unless args.y is k_none.
// Needs: a barrier after whatever made Values.
// Overflow: none.
#include "primitives/primitives.shared.glsl"
#include "primitives/group_scan.glsl"

layout(local_size_x = 256) in; // k_scan_group

layout(std430) buffer Values { uint values[]; };
layout(std430) buffer Counters { uint counters[]; };

void main()
{
    uint value_count = scan_count(counters[args.x], args.z, args.w);
    uint carry = 0u;
    for (uint tile_first = 0u; tile_first < value_count; tile_first += k_scan_tile) {
        uint first = tile_first + gl_LocalInvocationID.x * k_scan_run;
        uint last = min(first + k_scan_run, value_count);
        uint sum = 0u;
        for (uint i = first; i < last; ++i)
            sum += values[i];

        uint total;
        uint before = carry + group_scan(sum, total);
        for (uint i = first; i < last; ++i) {
            uint value = values[i];
            values[i] = before;
            before += value;
        }
        carry += total;
    }
    if (gl_LocalInvocationID.x == 0u && args.y != k_none) counters[args.y] = carry;
}
