// SPDX-License-Identifier: MIT
// All sub-steps of what no work group solves alone, in one launch: its groups stay until the end and wait for each other
// after every colour. That costs less than a launch does, the code is fetched once, and where there are no more manifolds
// than invocations each is loaded once. For worlds in which nothing bounces.
// args.x: 1 to count how many groups can run at a time instead.
// Reads: ColourOffsets, Hubs, Inertias, Shapes, Properties, Loads.
// Writes: Velocities, Deltas, WarmStarts, Constraints (impulses); Poses (flags) and Counters where a body is frozen;
// HubChanges, Arrivals.
// Needs: a barrier after prepare_contacts; no more groups than can run at a time; arrivals[0] is 0.
// Overflow: none; does nothing after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/contact.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/hit.shared.glsl"

layout(local_size_x = 384) in; // fewer leave waits unfilled; more have too few registers

layout(std430) readonly buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Hubs { uint hubs[]; };
layout(std430) coherent buffer HubChanges { HubChange hub_changes[]; };
layout(std430) coherent buffer Velocities { BodyVelocityCells velocities[]; };

uint slot_of(uint body) { return body; }
void store_velocity(uint body, BodyVelocity velocity) { velocities[body] = pack(velocity); }

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
BodyVelocity load_velocity(uint body)
{
    BodyVelocityCells velocity = velocities[body];
    return unpack(velocity);
}

#include "resolution/stored_deltas.glsl"

BodyDelta load_delta(uint body) { return load_stored_delta(body); }
void store_delta(uint body, BodyDelta delta) { store_stored_delta(body, delta); }

const bool k_bounces = false;
const bool k_hubs = true;

void put_change(uint index, HubChange change)
{
    hub_changes[index - colour_offsets[k_first_hub_colour]] = change;
}

// As of load_velocity.
HubChange load_change(uint i)
{
    HubChange change = hub_changes[i];
    return change;
}

#include "resolution/contact_passes.glsl"
#include "resolution/body_passes.glsl"
#include "resolution/move_hubs.glsl"
#include "primitives/grid_barrier.glsl"

// Neighbours in the order of manifolds are 32 by 32 in different groups, as there are often fewer of a colour than
// invocations: all multiprocessors are to have some.
const uint k_neighbours = 32u;

uint worker()
{
    uint me = gl_LocalInvocationID.x;
    return (me / k_neighbours * gl_NumWorkGroups.x + gl_WorkGroupID.x) * k_neighbours + me % k_neighbours;
}
uint worker_count() { return gl_NumWorkGroups.x * gl_WorkGroupSize.x; }

void wait_for_workers() { wait_for_all_groups(); }

void finish_colour(uint colour, uint substep)
{
    if (colour < k_first_hub_colour || colour >= k_max_colours) return;
    for (uint i = gl_WorkGroupID.x; i < counters[k_counter_hub_count]; i += gl_NumWorkGroups.x)
        move_hub_by_colour(hubs[i], colour, substep);
    wait_for_all_groups();
}

void integrate_own_bodies(uint substep)
{
    for (uint body = worker(); body < parameters.body_count; body += worker_count()) {
        if (is_launched(unpack(inertias[body]))) integrate_body(body, substep);
    }
}

#include "resolution/solve_substeps.glsl"

void main()
{
    if (args.x == 1u)
        count_resident_groups();
    else if (counters[k_counter_did_not_fit] == 0u)
        solve_substeps(max(counters[k_counter_launched_substeps], parameters.least_substeps));
}
