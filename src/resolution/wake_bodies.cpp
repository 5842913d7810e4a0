// SPDX-License-Identifier: MIT
// CPU twin of wake_bodies.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void wake_bodies_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_did_not_fit] != 0) return;
    state.parallel(state.parameters.body_count, [&](uint body) {
        const bool disturbed = state.loads[body].disturbed != 0;
        uint& flags = state.poses[body].flags;
        const bool is_gone = is_asleep(state.poses[body]) && !is_present(state.shapes[body]);
        if (disturbed || is_gone || launch.args[0] == 1) flags = wake_flags(flags) | (disturbed ? k_body_disturbed : 0);
    });
}

const Kernel wake_bodies{"resolution/wake_bodies", wake_bodies_on_cpu};

} // namespace talus::engine
