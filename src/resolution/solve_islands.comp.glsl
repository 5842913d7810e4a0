// SPDX-License-Identifier: MIT
// One group is an island: all its sub-steps, with velocities in shared memory. A pass over a colour costs a barrier here
// and a dispatch otherwise. The passes and their order are those of solve() in resolution.cpp, and so are the bits:
// islands do not touch each other. There is a group for each body slot; those that lead no island end at once.
// args.x: 1 where some body bounces, otherwise 0.
// Reads: Islands, ManifoldKeys, Counters, Constraints, Inertias, Shapes, Properties, Loads.
// Writes: Velocities, Deltas, WarmStarts, ConstraintPoints (impulses); Poses (flags) and Counters where a body is frozen.
// Needs: a barrier after prepare_contacts. At most k_island_bodies body slots.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/tangents.shared.glsl"
#include "resolution/contact.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 128) in;

layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) buffer Velocities { BodyVelocity velocities[]; };

shared vec4 linear_and_inverse_mass[k_island_bodies];
shared float angular[3u * k_island_bodies];
shared uint colour_offsets[k_max_colours + 2u]; // where the island's manifolds of each colour begin; the overflow set last

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

#include "resolution/contact_passes.glsl"
#include "resolution/body_passes.glsl"

const uint k_integrate_velocities = 4u;
const uint k_integrate_positions = 5u;

// What pass a sub-step makes as its number `phase`. The first sub-step has a warm start besides.
uint pass_of_phase(uint phase, bool first)
{
    uint first_solve = first ? 2u : 1u;
    uint after_solves = first_solve + parameters.iterations;
    if (phase == 0u) return k_integrate_velocities;
    if (phase < first_solve) return k_warm_start;
    if (phase < after_solves) return k_solve;
    return phase == after_solves ? k_integrate_positions : k_relax;
}

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

void pass_over_bodies(uint island, uint pass)
{
    for (uint body = gl_LocalInvocationID.x; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        if (islands[body] != island) continue;
        if (pass == k_integrate_velocities)
            integrate_body_velocity(body);
        else
            integrate_body_position(body);
    }
    memoryBarrierBuffer();
    barrier();
}

void pass_over_contacts(uint pass)
{
    uint last = colour_offsets[k_overflow_colour + 1u];
    for (uint colour = 0u; colour_offsets[colour] < last; ++colour) {
        uint index = colour_offsets[colour];
        uint end = colour_offsets[colour + 1u];
        if (index == end) continue;
        bool in_turn = colour == k_overflow_colour; // one after the other
        uint stride = in_turn ? 1u : gl_WorkGroupSize.x;
        if (in_turn && gl_LocalInvocationID.x > 0u) index = end;
        for (index += in_turn ? 0u : gl_LocalInvocationID.x; index < end; index += stride)
            pass_over_constraint(pass, index);
        barrier();
    }
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint island = group_index();
    if (islands[island] != island) return;
    if (me < k_max_colours + 2u) colour_offsets[me] = count_below(manifold_key(island, me));
    // Of other islands' bodies nothing is read; static ones have no island.
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        if (islands[body] == island || islands[body] == k_none) store_velocity(body, velocities[body]);
    }
    barrier();

    for (uint substep = 0u; substep < parameters.substeps + args.x; ++substep) {
        bool last = substep == parameters.substeps; // after the sub-steps: restitution alone
        uint phase_count = (substep == 0u ? 3u : 2u) + parameters.iterations + parameters.relax;
        for (uint phase = 0u; phase < (last ? 1u : phase_count); ++phase) {
            uint pass = last ? k_restitution : pass_of_phase(phase, substep == 0u);
            if (pass == k_integrate_velocities || pass == k_integrate_positions)
                pass_over_bodies(island, pass);
            else
                pass_over_contacts(pass);
        }
    }

    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        if (islands[body] == island) velocities[body] = load_velocity(body);
    }
}
