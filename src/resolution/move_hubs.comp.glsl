// SPDX-License-Identifier: MIT
// One group is a hub: adds up what the constraints of one colour have done to it. The order of the sum is fixed: each
// invocation takes every k_hub_group-th constraint, and then pairs of sums are added.
// args.x: the colour; args.z: the sub-step.
// Reads: Hubs, HubChanges, ColourOffsets, Inertias.
// Writes: Velocities.
// Needs: a barrier after solve_hub_contacts of the colour.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/hub.shared.glsl"

layout(local_size_x = 256) in; // k_hub_group

layout(std430) readonly buffer Hubs { uint hubs[]; };
layout(std430) readonly buffer HubChanges { HubChange hub_changes[]; };
layout(std430) readonly buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) readonly buffer Inertias { BodyInertiaCells inertias[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };

shared HubChange sums[k_hub_group];

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint hub = hubs[group_index()];
    if (args.z >= unpack(inertias[hub]).substeps || unpack(velocities[hub]).inverse_mass == 0.0) return;
    uint first = colour_offsets[k_first_hub_colour];
    uint end = colour_offsets[args.x + 1u] - first;
    HubChange sum = no_change(hub);
    for (uint i = colour_offsets[args.x] - first + me; i < end; i += k_hub_group) {
        if (hub_changes[i].body == hub) sum = add_changes(sum, hub_changes[i]);
    }
    sums[me] = sum;
    barrier();
    for (uint half_count = k_hub_group / 2u; half_count > 0u; half_count /= 2u) {
        if (me < half_count) sums[me] = add_changes(sums[me], sums[me + half_count]);
        barrier();
    }
    if (me == 0u) velocities[hub] = pack(move_hub(unpack(velocities[hub]), sums[0]));
}
