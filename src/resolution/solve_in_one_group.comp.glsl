// SPDX-License-Identifier: MIT
// One group: all sub-steps of a small world, with velocities in shared memory. A pass over a colour costs a barrier here
// and a dispatch otherwise. The passes and their order are those of solve() in resolution.cpp, and so are the bits.
// args.x: 1 where some body bounces, otherwise 0.
// Reads: Counters, ColourOffsets, Constraints, Inertias, Shapes, Properties, Loads.
// Writes: Velocities, Deltas, WarmStarts, ConstraintPoints (impulses); Poses (flags) and Counters where a body is frozen.
// Needs: a barrier after prepare_contacts. At most k_one_group_bodies body slots.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/tangents.shared.glsl"
#include "resolution/contact.shared.glsl"

layout(local_size_x = 512) in;

layout(std430) readonly buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) buffer Velocities { BodyVelocity velocities[]; };

shared vec4 linear_and_inverse_mass[k_one_group_bodies];
shared vec4 angular[k_one_group_bodies];

BodyVelocity load_velocity(uint body)
{
    BodyVelocity velocity;
    velocity.linear = linear_and_inverse_mass[body].xyz;
    velocity.inverse_mass = linear_and_inverse_mass[body].w;
    velocity.angular = angular[body].xyz;
    velocity.reserved = 0.0;
    return velocity;
}

void store_velocity(uint body, BodyVelocity velocity)
{
    linear_and_inverse_mass[body] = vec4(velocity.linear, velocity.inverse_mass);
    angular[body] = vec4(velocity.angular, 0.0);
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

void main()
{
    uint me = gl_LocalInvocationID.x;
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x)
        store_velocity(body, velocities[body]);
    barrier();

    uint colour_count = counters[k_counter_colour_demand];
    uint batch_count = colour_count + (counters[k_counter_overflow_count] > 0u ? 1u : 0u);
    for (uint substep = 0u; substep < parameters.substeps + args.x; ++substep) {
        bool last = substep == parameters.substeps; // after the sub-steps: restitution alone
        uint phase_count = (substep == 0u ? 3u : 2u) + parameters.iterations + parameters.relax;
        for (uint phase = 0u; phase < (last ? 1u : phase_count); ++phase) {
            uint pass = last ? k_restitution : pass_of_phase(phase, substep == 0u);
            if (pass >= k_integrate_velocities) {
                for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
                    if (pass == k_integrate_velocities)
                        integrate_body_velocity(body);
                    else
                        integrate_body_position(body);
                }
                memoryBarrierBuffer();
                barrier();
                continue;
            }
            for (uint batch = 0u; batch < batch_count; ++batch) {
                bool in_turn = batch == colour_count; // the overflow set, one after the other
                uint colour = in_turn ? k_overflow_colour : batch;
                uint end = colour_offsets[colour + 1u];
                uint index = colour_offsets[colour] + me;
                if (in_turn && me > 0u) index = end;
                for (; index < end; index += in_turn ? 1u : gl_WorkGroupSize.x)
                    pass_over_constraint(pass, index);
                barrier();
            }
        }
    }

    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x)
        velocities[body] = load_velocity(body);
}
