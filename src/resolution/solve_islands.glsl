// SPDX-License-Identifier: MIT
// One group is an island: all its sub-steps, with velocities in shared memory. A pass over a colour costs a barrier
// here and a dispatch otherwise. The passes and their order are those of solve() in resolution.cpp, and so are the
// bits: islands do not touch each other. There is a group for each body slot; those that lead no island end at once.
// An invocation keeps the manifold that it has in hand from pass to pass. Where there are more manifolds than
// invocations it takes the next one before it waits for the others, so that nobody waits for memory.
// Before this file the kernel defines k_bounces, as for contact_passes.glsl.
// Reads: Islands, ManifoldKeys, Counters, Constraints, Inertias, Shapes, Properties, Loads.
// Writes: Velocities, Deltas, WarmStarts, Constraints (impulses); Poses (flags) and Counters where a body is frozen.
// Needs: a barrier after prepare_contacts. At most k_island_bodies body slots.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/contact.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/hit.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 384) in; // most islands have no more manifolds; with more, registers get short

layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };

shared vec4 linear_and_inverse_mass[k_island_bodies];
shared float angular[3u * k_island_bodies];
shared Substep substep_of_moving;
shared Substep substep_against_static;
// Where the island's manifolds of each colour begin; the overflow set last.
shared uint colour_offsets[k_max_colours + 2u];

BodyVelocity load_velocity(uint body)
{
    BodyVelocity velocity;
    velocity.linear = linear_and_inverse_mass[body].xyz;
    velocity.inverse_mass = linear_and_inverse_mass[body].w;
    velocity.angular = vec3(angular[3u * body], angular[3u * body + 1u], angular[3u * body + 2u]);
    velocity.reserved = 0.0;
    return velocity;
}

void store_velocity(uint body, BodyVelocity velocity)
{
    linear_and_inverse_mass[body] = vec4(velocity.linear, velocity.inverse_mass);
    angular[3u * body] = velocity.angular.x;
    angular[3u * body + 1u] = velocity.angular.y;
    angular[3u * body + 2u] = velocity.angular.z;
}

Substep substep_of(uint substeps, bool against_static)
{
    if (against_static) return substep_against_static;
    return substep_of_moving;
}

const bool k_hubs = false; // a step that has some is made with a launch for each colour
void put_change(uint index, HubChange change) {}

#include "resolution/contact_passes.glsl"
#include "resolution/body_passes.glsl"

// How many manifolds have a lower key.
uint count_below(uint key)
{
    uint lower = 0u;
    uint upper = counters[k_counter_manifold_count];
    while (lower < upper) {
        uint middle = (lower + upper) / 2u;
        if (manifold_keys[middle] < key)
            lower = middle + 1u;
        else
            upper = middle;
    }
    return lower;
}

// This invocation's manifolds: every gl_WorkGroupSize.x-th of the island's, without the overflow set.
uint first_index;
uint end_index;
uint in_hand; // k_none: none

void take(uint index)
{
    if (index >= end_index) index = first_index; // round to the first again
    if (index == in_hand || index >= end_index) return;
    if (in_hand != k_none) put_back_impulses(in_hand);
    take_constraint(index);
    in_hand = index;
}

void pass_over_contacts(uint pass)
{
    PassTarget target;
    if (in_hand != k_none && pass != k_warm_start) target = target_of_pass(pass);
    uint colour_end = colour_offsets[0];
    for (uint colour = 0u; colour < k_max_colours && colour_end < colour_offsets[k_overflow_colour]; ++colour) {
        uint colour_begin = colour_end;
        colour_end = colour_offsets[colour + 1u];
        if (colour_begin == colour_end) continue;
        while (in_hand >= colour_begin && in_hand < colour_end) {
            uint done = in_hand;
            pass_over_constraint(pass, in_hand, target);
            take(in_hand + gl_WorkGroupSize.x);
            if (in_hand <= done) break; // that was the last one: the next pass begins with the first
            if (pass != k_warm_start) target = target_of_pass(pass);
        }
        barrier();
    }

    uint overflow_end = colour_offsets[k_overflow_colour + 1u];
    if (colour_offsets[k_overflow_colour] == overflow_end) return;
    if (gl_LocalInvocationID.x == 0u) { // one after the other
        if (in_hand != k_none) put_back_impulses(in_hand);
        in_hand = k_none;
        for (uint index = colour_offsets[k_overflow_colour]; index < overflow_end; ++index) {
            take_constraint(index);
            if (pass != k_warm_start) target = target_of_pass(pass);
            pass_over_constraint(pass, index, target);
            put_back_impulses(index);
        }
        take(first_index);
    }
    barrier();
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint island = group_index();
    if (islands[island] != island) return;
    uint last = unpack(inertias[island]).substeps;
    if (me == 0u) {
        substep_of_moving = make_substep(last, false, parameters);
        substep_against_static = make_substep(last, true, parameters);
    }
    if (me < k_max_colours + 2u) colour_offsets[me] = count_below(manifold_key(island, me));
    // Of other islands' bodies nothing is read; static ones have no island.
    uint own_bodies = 0u; // a bit for each body slot that is this invocation's
    for (uint i = 0u; me + i * gl_WorkGroupSize.x < parameters.body_count; ++i) {
        uint body = me + i * gl_WorkGroupSize.x;
        uint its_island = islands[body];
        if (its_island == island) own_bodies |= 1u << i;
        if (its_island == island || its_island == k_none) store_velocity(body, unpack(velocities[body]));
    }
    barrier();
    first_index = colour_offsets[0] + me;
    end_index = colour_offsets[k_overflow_colour];
    in_hand = k_none;
    take(first_index);

    for (uint substep = 0u; substep <= last; ++substep) {
        for (uint i = 0u; own_bodies >> i != 0u; ++i) {
            if (((own_bodies >> i) & 1u) == 1u) integrate_body(me + i * gl_WorkGroupSize.x, substep);
        }
        groupMemoryBarrier();
        barrier();
        if (substep == last) break;
        if (substep == 0u) pass_over_contacts(k_warm_start);
        for (uint i = 0u; i < parameters.iterations; ++i)
            pass_over_contacts(i == 0u ? k_solve : k_solve_again);
    }
    if (parameters.relax == 1u) pass_over_contacts(k_relax);

    if (in_hand != k_none) put_back_impulses(in_hand);
    for (uint i = 0u; own_bodies >> i != 0u; ++i) {
        uint body = me + i * gl_WorkGroupSize.x;
        if (((own_bodies >> i) & 1u) == 1u) velocities[body] = pack(load_velocity(body));
    }
}
