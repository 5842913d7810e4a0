// SPDX-License-Identifier: MIT
// One invocation is a body slot: it is hung from its root itself. What is joined then finds that two bodies are of one island by looking
// at these alone.
// Reads: Counters, Islands.
// Writes: Islands. On its way an invocation may pass what others have hung from the same root meanwhile.
// Needs: a barrier after join_islands.
// Overflow: none.
layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) buffer Islands { uint islands[]; };

#include "resolution/root_of.glsl"

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_graph_bodies] || islands[body] == k_none) return;
    islands[body] = root_of(body); // roots stay what they are
}
