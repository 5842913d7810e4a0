// SPDX-License-Identifier: MIT
// CPU twin of wake_neighbours.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void wake_neighbours_on_cpu(CpuState& state, const Launch&) {
    if (state.counters[k_counter_did_not_fit] != 0) return;
    const uint body_count = state.parameters.body_count;
    const auto has_changed = [&](uint body) {
        return body >= body_count || !is_present(state.shapes[body]) ||
               (state.poses[body].flags & k_body_disturbed) != 0;
    };
    const auto wake = [&](uint body) {
        if (body < body_count && is_asleep(state.poses[body]))
            state.poses[body].flags = wake_flags(state.poses[body].flags);
    };
    for (uint pair = 0; pair < state.counters[k_counter_old_pair_count]; ++pair) {
        const Manifold& manifold = state.old_manifolds[pair];
        if (manifold.point_count == 0) continue;
        if (has_changed(manifold.body_a)) wake(manifold.body_b);
        if (has_changed(manifold.body_b)) wake(manifold.body_a);
    }
}

const Kernel wake_neighbours{"resolution/wake_neighbours", wake_neighbours_on_cpu};

} // namespace talus::engine
