// SPDX-License-Identifier: MIT
// CPU twin of finish_bodies.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "finish/finish.h"
#include "state/formulas.h"

namespace talus::engine {

static void finish_bodies_on_cpu(CpuState& state, const Launch&) {
    state.counters[k_counter_old_pair_count] = state.counters[k_counter_pair_count];
    state.parallel(state.parameters.body_count, [&](uint body) {
        if (!is_mover(state.shapes[body])) return;
        state.loads[body] = no_load();
        BodyPose& pose = state.poses[body];
        if ((pose.flags & k_body_frozen) != 0) return;
        const BodyPose moved = apply_delta(pose, state.deltas[body]);
        if (is_finite_motion(moved, state.velocities[body])) {
            pose = moved;
        } else {
            pose.flags |= k_body_frozen;
            state.velocities[body] = frozen_velocity();
            std::atomic_ref(state.counters[k_counter_frozen_bodies]).fetch_add(1);
        }
    });
}

const Kernel finish_bodies{"finish/finish_bodies", finish_bodies_on_cpu};

} // namespace talus::engine
