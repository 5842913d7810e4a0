// SPDX-License-Identifier: MIT
// What a sub-step does to one body. Before this file the kernel defines slot_of, store_velocity, load_delta and
// k_multirate_islands, as for contact_passes.glsl, and
//   bool is_own(BodyInertia inertia), whether the kernel solves such a body
//   BodyVelocity load_settled_velocity(uint slot, uint its_traits), once all contacts of the sub-step before are passed over
//   void store_delta(uint body, uint slot, BodyDelta delta)
//   bool some_bounce(), whether there may be a restitution above 0, with stored_hits.glsl or no_hits.glsl
// and it declares Properties, Inertias, WarmStarts and Counters. The CPU's counterpart is body_passes.h.
// Reads: Properties, Loads, Inertias. Reads and writes: Poses (its flags), WarmStarts, Deltas.

#include "resolution/body_load.glsl"

layout(std430) buffer Poses { BodyPoseCells poses[]; };

// Where the tick begins a sub-step of the body, ends the one before with its movement, and begins the new one with its
// forces: between the two nothing happens. A body whose sub-steps are all done is left alone.
void integrate_body(uint body, uint tick)
{
    BodyInertia inertia = unpack(inertias[body]);
    // All at once, as loads behind a decision wait for what it is made from; but for what the caller does.
    BodyPose pose = unpack(poses[body]);
    uint slot = slot_of(body);
    BodyDelta delta = load_delta(body, slot);
    BodyWarmStart warm = load_warm_start(body);
    BodyProperties its_properties = unpack(properties[body]);
    BodyLoad load = load_of_body(body, inertia);
    uint substep = k_multirate_islands ? substep_at(tick, inertia.traits) : tick;
    bool takes_part = substep <= inertia.substeps && is_own(inertia) && (inertia.traits & k_trait_moves) != 0u;
    if (takes_part && (pose.flags & k_body_frozen) == 0u) {
        BodyVelocity velocity = load_settled_velocity(slot, inertia.traits);
        float h = substep_length(inertia.substeps, parameters);
        if (substep > 0u) {
            BodyVelocity limited = limit_speeds(velocity, parameters);
            warm = leave_out(warm, velocity, limited);
            velocity = limited;
            vec3 falling = falling_acceleration(velocity, warm, its_properties, inertia, load, h, parameters);
            vec3 shift = some_bounce() ? load_hits(body).shift : vec3(0.0);
            delta = integrate_position(delta, shift, velocity, falling, h);
            store_delta(body, slot, delta);
        }
        if (substep < inertia.substeps) {
            vec4 rotation = multiply_quaternions(delta.rotation, pose.rotation);
            warm = gather_impulses(warm, velocity);
            velocity = integrate_velocity(velocity, warm, rotation, its_properties, inertia, load,
                                          (inertia.traits & k_trait_movable) != 0u, h, parameters);
            if (!is_finite3(velocity.linear) || !is_finite3(velocity.angular)) {
                velocity = frozen_velocity();
                warm = no_warm_start();
                pose.flags |= k_body_frozen;
                poses[body] = pack(pose);
                atomicAdd(counters[k_counter_frozen_bodies], 1u);
            }
            if (some_bounce()) store_hits(body, no_hits(warm));
            warm_starts[body] = pack(kept_warm_start(warm, velocity));
            store_velocity(slot, velocity);
        }
    }
}
