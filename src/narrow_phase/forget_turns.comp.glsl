// SPDX-License-Identifier: MIT
// One invocation is a body that the caller has changed: how it turned in the last step is forgotten, and none of its contacts lasts.
// Reads: Changes: the places of args.x bodies; Counters.
// Writes: Starts.
// Needs: a barrier after finish_bodies. No body is named twice.
// Overflow: after a step that did not fit nothing is written, as of other changes (scatter_records).
#include "state/math.shared.glsl"
#include "finish/body_start.shared.glsl"

layout(local_size_x = 64) in; // k_group_size

layout(std430) readonly buffer Changes { uint changes[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) buffer Starts { BodyStartCells starts[]; };

void main()
{
    if (item_index() >= args.x || counters[k_counter_did_not_fit] != 0u) return;
    uint body = changes[item_index()];
    starts[body] = pack(forget_turn(unpack(starts[body])));
}
