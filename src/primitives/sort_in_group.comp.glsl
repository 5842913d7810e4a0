// SPDX-License-Identifier: MIT
// A whole sort by a single work group, in shared memory.
// One invocation is a comparison of each round, and a key before and after; launched as one group.
// Reads: Keys, Values; Counters[args.x], the number of keys. args.y: 1 where Values get the place of each key, and are not read.
// Writes: Keys, Values, in place.
// Needs: a barrier after whatever made them.
// Overflow: none; the host launches it for at most k_sort_in_group_keys keys.
#include "primitives/primitives.shared.glsl"

layout(local_size_x = 512) in;

layout(std430) buffer Keys { uint keys[]; };
layout(std430) buffer Values { uint values[]; };
layout(std430) readonly buffer Counters { uint counters[]; };

#include "primitives/group_sort.glsl"

shared uint old_values[k_sort_in_group_keys];

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint key_count = counters[args.x];
    uint room = sort_room(key_count);
    for (uint i = me; i < room; i += gl_WorkGroupSize.x) {
        bool is_key = i < key_count;
        sorted_keys[i] = is_key ? keys[i] : 0xffffffffu;
        old_places[i] = i;
        if (is_key && args.y == 0u) old_values[i] = values[i];
    }
    barrier();
    sort_group(room);
    for (uint i = me; i < key_count; i += gl_WorkGroupSize.x) {
        keys[i] = sorted_keys[i];
        if (args.y == 1u)
            values[old_places[i]] = i;
        else
            values[i] = old_values[old_places[i]];
    }
}
