// SPDX-License-Identifier: MIT
// The passes over one body, for the CPU. The GPU's counterpart is body_passes.glsl.
#pragma once

#include <atomic>

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

inline bool moves(const CpuState& state, uint body) {
    return is_mover(state.shapes[body]) && (state.poses[body].flags & k_body_frozen) == 0;
}

inline void integrate_body_velocity(CpuState& state, uint body) {
    if (!moves(state, body)) return;
    const vec4 rotation = multiply_quaternions(state.deltas[body].rotation, state.poses[body].rotation);
    BodyVelocity velocity = state.velocities[body];
    BodyWarmStart warm = gather_impulses(state.warm_starts[body], velocity);
    velocity = integrate_velocity(velocity, warm, rotation, state.properties[body], state.inertias[body],
                                  state.loads[body], is_movable(state.shapes[body]), state.parameters);
    if (!is_finite3(velocity.linear) || !is_finite3(velocity.angular)) {
        velocity = frozen_velocity();
        warm = no_warm_start(velocity);
        state.poses[body].flags |= k_body_frozen;
        std::atomic_ref(state.counters[k_counter_frozen_bodies]).fetch_add(1);
    }
    warm.linear_before = velocity.linear;
    warm.angular_before = velocity.angular;
    state.warm_starts[body] = warm;
    state.velocities[body] = velocity;
}

inline void integrate_body_position(CpuState& state, uint body) {
    if (moves(state, body))
        state.deltas[body] = integrate_position(state.deltas[body], state.velocities[body], state.parameters.h);
}

} // namespace talus::engine
