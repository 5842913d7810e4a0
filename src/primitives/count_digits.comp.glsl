// SPDX-License-Identifier: MIT
// First part of a pass of the radix sort: how often each digit value occurs in each tile of keys.
// One invocation is a key of each row of the tile, then a digit value; one group is a tile of k_sort_tile keys.
// Reads: Keys; Counters[args.x], the number of keys. The digit is the 8 bits of the key from bit args.y up.
// Writes: DigitCounts, all k_digits entries of the tile.
// Needs: a barrier before the scan of DigitCounts. The order in which the atomics land does not show in a count.
// Overflow: none; tiles beyond the number of keys write nothing.
#include "primitives/primitives.shared.glsl"

layout(local_size_x = 256) in; // k_sort_group

layout(std430) readonly buffer Keys { uint keys[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) writeonly buffer DigitCounts { uint digit_counts[]; };

shared uint counts[k_digits];

void main()
{
    uint key_count = counters[args.x];
    uint tile_count = divide_up(key_count, k_sort_tile);
    uint tile = group_index();
    if (tile >= tile_count) return;

    uint me = gl_LocalInvocationID.x;
    counts[me] = 0u;
    barrier();
    for (uint row = 0u; row < k_sort_tile; row += k_sort_group) {
        uint i = tile * k_sort_tile + row + me;
        if (i < key_count) atomicAdd(counts[digit_of(keys[i], args.y)], 1u);
    }
    barrier();
    digit_counts[digit_count_index(me, tile, tile_count)] = counts[me];
}
