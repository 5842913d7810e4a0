// SPDX-License-Identifier: MIT
// All sub-steps of what no work group solves alone, in one launch: its groups stay until the end and wait for each other
// before every pass, and within it contact by contact (solve_in_order.glsl). That costs less than a launch for each colour
// does, the code is fetched once, and where there are no more manifolds than invocations each is loaded once. For worlds in
// which nothing bounces.
// Before this file the kernel defines k_multirate_islands, as for contact_passes.glsl.
// args.x: 1 to count how many groups can run at a time instead. args.y: 1 where some body is kinematic.
// Reads: Counters, ColourOffsets, Hubs, LaunchedBodies, Inertias, Properties, Loads.
// Writes: Velocities, Deltas, WarmStarts, Constraints (impulses); Poses (flags) and Counters where a body is frozen;
// HubChanges, FastBodies, Arrivals.
// Needs: a barrier after prepare_contacts; no more groups than can run at a time; Arrivals as plan_colours leaves it.
// Overflow: none; does nothing after a step that did not fit. It has 16 storage blocks, which is as many as there may be.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_counts.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/island.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/contact.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/hit.shared.glsl"
#include "resolution/stamp.shared.glsl"

layout(local_size_x = 256) in; // more have too few registers, and a hub takes k_hub_group

layout(std430) readonly buffer ColourOffsets { uint stored_offsets[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Hubs { uint hubs[]; };
layout(std430) readonly buffer LaunchedBodies { uint launched_bodies[]; };
layout(std430) coherent buffer HubChanges { HubChange hub_changes[]; };
layout(std430) coherent volatile buffer Velocities { BodyVelocityCells velocities[]; };

// As in ColourOffsets: a load for each colour that is not in use took as long as the passes did, where there are hubs.
shared uint colour_offsets[k_colour_offsets];

uint slot_of(uint body) { return body; }

void store_velocity(uint body, BodyVelocity velocity)
{
    velocity.stamp = 0u; // see solve_in_order.glsl
    velocities[body] = pack(velocity);
}

BodyVelocity load_velocity(uint body); // see solve_in_order.glsl

#include "resolution/stored_deltas.glsl"

BodyDelta load_delta(uint body, uint slot) { return load_stored_delta(body); }
void store_delta(uint body, uint slot, BodyDelta delta) { store_stored_delta(body, delta); }

const bool k_bounces = false;
const bool k_hubs = true;

void put_change(uint index, HubChange change)
{
    hub_changes[index - colour_offsets[k_first_hub_colour]] = change;
}

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
HubChange load_change(uint i)
{
    HubChange change = hub_changes[i];
    return change;
}

#include "resolution/no_hits.glsl"
#include "resolution/contact_passes.glsl"
#include "resolution/move_hubs.glsl"
uint meeting_groups() { return gl_NumWorkGroups.x; }
#include "primitives/grid_barrier.glsl"
const bool k_notes_unlike = true;
#include "resolution/solve_substeps.glsl"
#include "resolution/solve_in_order.glsl"

bool moves_hub = false; // the present body is a hub, and the invocation its keeper

bool is_own(BodyInertia inertia) { return moves_hub ? is_launched(inertia) : is_in_launched_bodies(inertia); }

#include "resolution/body_passes.glsl"

// Groups are adding up what contacts have done to hubs: nobody else may read a hub's velocity before the next wait.
bool hubs_move = false;

void wait_for_workers()
{
    wait_for_all_groups();
    hubs_move = false;
}

void wait_for_finish()
{
    if (hubs_move) wait_for_workers();
}

void finish_colour(uint colour, uint tick)
{
    for (uint i = gl_WorkGroupID.x; i < counters[k_counter_hub_count]; i += gl_NumWorkGroups.x)
        move_hub_by_colour(hubs[i], colour, tick);
    hubs_move = true;
}

void integrate_own_bodies(uint tick)
{
    // A hub is its keeper's, which has moved it and need not wait to see that.
    uint hub_count = counters[k_counter_hub_count];
    uint hub = worker == k_hub_keeper ? gl_WorkGroupID.x : hub_count;
    // Where most bodies are launched, to look at all of them is quicker than to ask a list which they are.
    uint launched = counters[k_counter_launched_bodies];
    bool looks_at_all = 2u * launched > parameters.body_count;
    uint count = looks_at_all ? parameters.body_count : launched;
    bool all = most_have_substep(tick);
    if (!all) count = count_fast_bodies(tick);
    uint end = part_begin(count, gl_WorkGroupID.x + 1u);
    uint next = part_begin(count, gl_WorkGroupID.x) + worker;
    while (hub < hub_count || next < end) {
        uint body;
        moves_hub = hub < hub_count;
        if (moves_hub) {
            body = hubs[hub];
            hub += gl_NumWorkGroups.x;
        } else if (all) {
            body = looks_at_all ? next : launched_bodies[next];
            next += workers();
        } else {
            uint entry = fast_entry(next);
            next += workers();
            if (!listed_has_substep(entry, tick)) continue;
            body = listed_body(entry);
        }
        if (k_multirate_islands && tick == 0u) {
            forget_fast_colours(body);
            BodyInertia inertia = unpack(inertias[body]);
            uint r = slowness(inertia.traits);
            if (!moves_hub && is_own(inertia) && (1u << r) != ticks_apart) list_fast_body(body, r);
        }
        integrate_body(body, tick);
        bool keeps_stamps = parameters.relax == 0u && tick == like_substeps * ticks_apart;
        if (keeps_stamps && is_own(unpack(inertias[body]))) take_stamps_away(body);
    }
}

void main()
{
    if (args.x == 1u) {
        count_resident_groups();
        return;
    }
    if (counters[k_counter_did_not_fit] != 0u) return;
    for (uint i = gl_LocalInvocationID.x; i < k_colour_offsets; i += gl_WorkGroupSize.x)
        colour_offsets[i] = stored_offsets[i];
    barrier();
    solve_substeps(max(counters[k_counter_launched_substeps], parameters.least_substeps));
}
