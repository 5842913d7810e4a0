// SPDX-License-Identifier: MIT
// Where each key value starts among sorted keys, by binary search.
// One invocation is a key value; launched for k_digits + 1 items.
// Reads: Keys, sorted and below k_digits; Counters[args.x], the number of keys.
// Writes: Offsets, k_digits + 1 entries; the last is the number of keys.
// Needs: a barrier after the sort.
// Overflow: none.
layout(local_size_x = 64) in; // k_group_size

layout(std430) readonly buffer Keys { uint keys[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Offsets { uint offsets[]; };

void main()
{
    uint wanted = item_index();
    if (wanted > k_digits) return;

    // All keys before `first` are below the wanted one, none from `last` on is.
    uint first = 0u;
    uint last = counters[args.x];
    while (first < last) {
        uint middle = first + (last - first) / 2u;
        if (keys[middle] < wanted)
            first = middle + 1u;
        else
            last = middle;
    }
    offsets[wanted] = first;
}
