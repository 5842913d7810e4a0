// SPDX-License-Identifier: MIT
// A group adds up what the constraints of one colour have done to a hub. The order of the sum is fixed: each of
// k_hub_group invocations takes every k_hub_group-th constraint, and then pairs of sums are added.
// Before this file the kernel has load_velocity and store_velocity as for contact_passes.glsl, declares ColourOffsets,
// Inertias and HubChanges, and defines HubChange load_change(uint i).

const uint k_hub_keeper = k_hub_group - 1u; // the invocation that moves a hub

shared HubChange hub_sums[k_hub_group];

// In uniform control flow.
void move_hub_by_colour(uint hub, uint colour, uint tick)
{
    uint me = gl_LocalInvocationID.x;
    BodyInertia inertia = unpack(inertias[hub]);
    if (substep_at(tick, inertia.traits) >= inertia.substeps || load_velocity(hub).inverse_mass == 0.0) return;
    uint first = colour_offsets[k_first_hub_colour];
    uint end = colour_offsets[colour + 1u] - first;
    if (me < k_hub_group) {
        HubChange sum = no_change(hub);
        for (uint i = colour_offsets[colour] - first + me; i < end; i += k_hub_group) {
            HubChange change = load_change(i);
            if (change.body == hub && change.tick == tick) sum = add_changes(sum, change);
        }
        hub_sums[me] = sum;
    }
    barrier();
    for (uint half_count = k_hub_group / 2u; half_count > 0u; half_count /= 2u) {
        if (me < half_count) hub_sums[me] = add_changes(hub_sums[me], hub_sums[me + half_count]);
        barrier();
    }
    if (me == k_hub_keeper) store_velocity(hub, move_hub(load_velocity(hub), hub_sums[0]));
    barrier(); // before the sums are of another hub
}
