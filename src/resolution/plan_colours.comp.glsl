// SPDX-License-Identifier: MIT
// One invocation: what the colouring came to, and the launches of the resolution.
// Reads: ColourOffsets, Counters.
// Writes: Counters, Dispatches.
// Needs: a barrier after the sort of the manifolds by colour.
// Overflow: more colours than the host has launches for are said in k_counter_did_not_fit. Where that is set, by this
// step or an earlier one, all launches are empty.
#include "state/dispatch.shared.glsl"

layout(local_size_x = 1) in;

layout(std430) readonly buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Dispatches { Dispatch dispatches[]; };

void main()
{
    uint colour_demand = 0u;
    for (uint colour = 0u; colour < k_max_colours; ++colour) {
        if (colour_offsets[colour] < colour_offsets[colour + 1u]) colour_demand = colour + 1u;
    }
    uint overflow_count = colour_offsets[k_overflow_colour + 1u] - colour_offsets[k_overflow_colour];
    if (colour_demand > parameters.colour_capacity || (overflow_count > 0u && parameters.overflow_capacity == 0u))
        counters[k_counter_did_not_fit] |= k_fit_colours;
    uint manifold_count = colour_offsets[k_inactive_colour];
    counters[k_counter_colour_demand] = colour_demand;
    counters[k_counter_overflow_count] = overflow_count;
    counters[k_counter_manifold_count] = manifold_count;

    uint on = counters[k_counter_did_not_fit] == 0u ? 1u : 0u;
    dispatches[k_dispatch_once] = groups_for(on, 1u);
    dispatches[k_dispatch_bodies] = groups_for(on * parameters.body_count, k_group_size);
    dispatches[k_dispatch_manifolds] = groups_for(on * manifold_count, k_group_size);
    for (uint colour = 0u; colour < k_max_colours; ++colour) {
        uint count = colour_offsets[colour + 1u] - colour_offsets[colour];
        dispatches[k_dispatch_colours + colour] = groups_for(on * count, k_group_size);
    }
    dispatches[k_dispatch_overflow] = groups_for(on * min(overflow_count, 1u), 1u);
}
