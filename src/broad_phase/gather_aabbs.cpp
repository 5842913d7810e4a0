// SPDX-License-Identifier: MIT
// CPU twin of gather_aabbs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"

namespace talus::engine {

static void gather_aabbs_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.parameters.body_count,
                   [&](uint place) { state.sorted_aabbs[place] = state.aabbs[state.sort_values[place]]; });
}

const Kernel gather_aabbs{"broad_phase/gather_aabbs", gather_aabbs_on_cpu};

} // namespace talus::engine
