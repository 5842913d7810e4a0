// SPDX-License-Identifier: MIT
// CPU twin of update_aabbs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void update_aabbs_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.parameters.body_count, [&](uint body) {
        state.aabbs[body] =
            compute_aabb(state.poses[body], state.velocities[body], state.shapes[body], state.parameters);
    });
}

const Kernel update_aabbs{"broad_phase/update_aabbs", update_aabbs_on_cpu};

} // namespace talus::engine
