// SPDX-License-Identifier: MIT
// CPU twin of update_aabbs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void update_aabbs_on_cpu(CpuState& state, const Launch&) {
    const Parameters& p = state.parameters;
    state.parallel(state.counters[k_counter_search_count], [&](uint body) {
        const Aabb box = compute_aabb(state.poses[body], state.velocities[body], state.shapes[body], p);
        state.aabbs[body] = with_skin(box, p);
    });
}

const Kernel update_aabbs{"broad_phase/update_aabbs", update_aabbs_on_cpu};

} // namespace talus::engine
