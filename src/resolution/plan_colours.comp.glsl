// SPDX-License-Identifier: MIT
// One group, an invocation for each colour: whether the colours and the sub-steps fit, and the launches of the
// resolution. args.x: 1 where a work group solves an island, so that neither needs launches; hubs cannot be solved there.
// Reads: ColourOffsets, Counters.
// Writes: Counters, Dispatches.
// Needs: a barrier after the sort of the manifolds.
// Overflow: more colours or sub-steps than the host has launches for, and more manifolds of hubs than it has room for,
// are said in k_counter_did_not_fit. Where that is set, by this step or an earlier one, all launches are empty.
#include "state/dispatch.shared.glsl"

layout(local_size_x = 64) in; // k_max_colours

layout(std430) readonly buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Dispatches { Dispatch dispatches[]; };

void main()
{
    uint colour = gl_LocalInvocationID.x;
    bool in_groups = args.x == 1u;
    uint overflow_count = counters[k_counter_overflow_count];
    uint did_not_fit = counters[k_counter_did_not_fit];
    if (!in_groups && (counters[k_counter_colour_demand] > parameters.colour_capacity ||
                       (overflow_count > 0u && parameters.overflow_capacity == 0u)))
        did_not_fit |= k_fit_colours;
    if (!in_groups && counters[k_counter_substep_demand] > parameters.substep_capacity) did_not_fit |= k_fit_substeps;

    if (counters[k_counter_hub_manifolds] > (in_groups ? 0u : parameters.hub_capacity)) did_not_fit |= k_fit_hubs;

    uint on = did_not_fit == 0u ? 1u : 0u;
    uint count = in_groups ? 0u : colour_offsets[colour + 1u] - colour_offsets[colour];
    dispatches[k_dispatch_colours + colour] = groups_for(on * count, k_group_size);
    if (colour != 0u) return;
    dispatches[k_dispatch_bodies] = groups_for(on * parameters.body_count, k_group_size);
    dispatches[k_dispatch_manifolds] = groups_for(on * counters[k_counter_manifold_count], k_group_size);
    dispatches[k_dispatch_islands] = groups_for(on * parameters.body_count, 1u);
    dispatches[k_dispatch_overflow] = groups_for(on * min(overflow_count, 1u), 1u);
    dispatches[k_dispatch_hubs] = groups_for(on * counters[k_counter_hub_count], 1u);
    counters[k_counter_did_not_fit] = did_not_fit;
}
