// SPDX-License-Identifier: MIT
// A sort by the invocations of one work group: a bitonic network over (key, old place). No two of those are equal, so
// the result is that of a stable sort.

shared uint sorted_keys[k_sort_in_group_keys];
shared uint old_places[k_sort_in_group_keys];

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

// The network's width: a power of two.
uint sort_room(uint key_count)
{
    uint room = 1u;
    while (room < key_count) room *= 2u;
    return room;
}

// Before it, each of the `room` places has its key and its own number; what fills the room up comes behind every key,
// even behind one with all bits set, as its place is later. Every invocation must call it, after a barrier; it ends
// with one.
void sort_group(uint room)
{
    uint me = gl_LocalInvocationID.x;
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
}
