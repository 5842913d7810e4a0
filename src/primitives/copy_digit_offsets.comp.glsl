// SPDX-License-Identifier: MIT
// After a sort: where the keys with each value of the last digit start.
// One invocation is a digit value; launched for k_digits + 1 items.
// Reads: DigitCounts as the last pass left it; Counters[args.x], the number of keys.
// Writes: Offsets, k_digits + 1 entries; the last is the number of keys.
// Needs: a barrier after the sort, and no other sort in between.
// Overflow: none.
#include "primitives/primitives.shared.glsl"

layout(local_size_x = 64) in; // k_group_size

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer DigitCounts { uint digit_counts[]; };
layout(std430) writeonly buffer Offsets { uint offsets[]; };

void main()
{
    uint digit = item_index();
    if (digit > k_digits) return;

    uint key_count = counters[args.x];
    uint offset = key_count;
    if (digit < k_digits && key_count > 0u)
        offset = digit_counts[digit_count_index(digit, 0u, divide_up(key_count, k_sort_tile))];
    offsets[digit] = offset;
}
