// SPDX-License-Identifier: MIT
// A whole sort by a single work group, in shared memory: a bitonic network over (key, old place). No two of those are
// equal, so the result is that of a stable sort.
// One invocation is a comparison of each round, and a key before and after; launched as one group.
// Reads: Keys, Values; Counters[args.x], the number of keys.
// Writes: Keys, Values, in place.
// Needs: a barrier after whatever made them.
// Overflow: none; the host launches it for at most k_sort_in_group_keys keys.
#include "primitives/primitives.shared.glsl"

layout(local_size_x = 512) in;

layout(std430) buffer Keys { uint keys[]; };
layout(std430) buffer Values { uint values[]; };
layout(std430) readonly buffer Counters { uint counters[]; };

shared uint sorted_keys[k_sort_in_group_keys];
shared uint old_places[k_sort_in_group_keys];
shared uint old_values[k_sort_in_group_keys];

void put_in_order(uint low, uint high)
{
    uint low_key = sorted_keys[low];
    uint high_key = sorted_keys[high];
    uint low_place = old_places[low];
    uint high_place = old_places[high];
    if (low_key < high_key || (low_key == high_key && low_place < high_place)) return;
    sorted_keys[low] = high_key;
    sorted_keys[high] = low_key;
    old_places[low] = high_place;
    old_places[high] = low_place;
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint key_count = counters[args.x];
    uint room = 1u; // the network's width: a power of two
    while (room < key_count) room *= 2u;

    // What fills the room up comes behind every key, even behind one with all bits set: its place is later.
    for (uint i = me; i < room; i += gl_WorkGroupSize.x) {
        bool is_key = i < key_count;
        sorted_keys[i] = is_key ? keys[i] : 0xffffffffu;
        old_places[i] = i;
        if (is_key) old_values[i] = values[i];
    }
    barrier();

    // Sorted halves make a sorted whole of `size`: the first round compares mirror images, the others neighbours at a
    // distance, and all of them put the lower one first.
    for (uint size = 2u; size <= room; size *= 2u) {
        for (uint distance = size / 2u; distance > 0u; distance /= 2u) {
            for (uint i = me; i < room / 2u; i += gl_WorkGroupSize.x) {
                uint low = 2u * i - (i & (distance - 1u));
                uint high = distance == size / 2u ? low ^ (size - 1u) : low + distance;
                put_in_order(low, high);
            }
            barrier();
        }
    }

    for (uint i = me; i < key_count; i += gl_WorkGroupSize.x) {
        keys[i] = sorted_keys[i];
        values[i] = old_values[old_places[i]];
    }
}
