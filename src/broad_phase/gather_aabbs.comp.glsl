// SPDX-License-Identifier: MIT
// One invocation is a place in the sorted order: its body's box, so that the sweep reads boxes one after the other.
// Reads: Aabbs, SortValues.
// Writes: SortedAabbs.
// Needs: a barrier after the sort.
// Overflow: none.
layout(local_size_x = 64) in;

layout(std430) readonly buffer Aabbs { Aabb aabbs[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) writeonly buffer SortedAabbs { Aabb sorted_aabbs[]; };

void main()
{
    uint place = item_index();
    if (place < parameters.body_count) sorted_aabbs[place] = aabbs[sort_values[place]];
}
