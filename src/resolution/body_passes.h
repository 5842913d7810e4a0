// SPDX-License-Identifier: MIT
// What a sub-step does to one body, for the CPU. The GPU's counterpart is body_passes.glsl.
#pragma once

#include <atomic>

#include "resolution/body_load.h"
#include "resolution/stored_hits.h"
#include "state/formulas.h"

namespace talus::engine {

/// Where the tick begins a sub-step of the body, ends the one before with its movement, and begins the new one with its
/// forces: between the two nothing happens. A body whose sub-steps are all done is left alone, and one that sleeps, as
/// it has none.
inline void integrate_body(CpuState& state, uint body, uint tick) {
    const BodyInertia& inertia = state.inertias[body];
    const uint substep = substep_at(tick, inertia.traits);
    BodyPose& pose = state.poses[body];
    if (substep > inertia.substeps || inertia.substeps == 0 || (inertia.traits & k_trait_moves) == 0) return;
    if ((pose.flags & k_body_frozen) != 0) return;
    const float h = substep_length(inertia.substeps, state.parameters);
    BodyVelocity velocity = state.velocities[body];
    BodyDelta& delta = state.deltas[body];
    const BodyProperties& properties = state.properties[body];
    const BodyLoad load = load_of_body(state, body);
    BodyWarmStart warm = state.warm_starts[body];
    if (substep > 0) {
        const BodyVelocity limited = limit_speeds(velocity, state.parameters);
        warm = leave_out(warm, velocity, limited);
        velocity = limited;
        const vec3 falling = falling_acceleration(velocity, warm, properties, inertia, load, h, state.parameters);
        const vec3 shift = state.some_bounce ? hits_of(state, body).shift : vec3(0.0f);
        delta = integrate_position(delta, shift, velocity, falling, h);
    }
    if (substep == inertia.substeps) return;

    const vec4 rotation = multiply_quaternions(delta.rotation, pose.rotation);
    warm = gather_impulses(warm, velocity);
    velocity = integrate_velocity(velocity, warm, rotation, properties, inertia, load,
                                  (inertia.traits & k_trait_movable) != 0, h, state.parameters);
    if (!is_finite3(velocity.linear) || !is_finite3(velocity.angular)) {
        velocity = frozen_velocity();
        warm = no_warm_start();
        pose.flags |= k_body_frozen;
        std::atomic_ref(state.counters[k_counter_frozen_bodies]).fetch_add(1);
    }
    if (state.some_bounce) put_hits(state, body, no_hits(warm));
    state.warm_starts[body] = kept_warm_start(warm, velocity);
    state.velocities[body] = velocity;
}

} // namespace talus::engine
