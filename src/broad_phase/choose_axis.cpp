// SPDX-License-Identifier: MIT
// CPU twin of choose_axis.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "broad_phase/sum_spread.h"

namespace talus::engine {

static void choose_axis_on_cpu(CpuState& state, const Launch&) {
    if (state.counters[k_counter_search_count] == 0) return;
    state.sweep_axes[0] = choose_sweep_axis(sum_spread(state), state.parameters.body_count);
}

const Kernel choose_axis{"broad_phase/choose_axis", choose_axis_on_cpu, 1};

} // namespace talus::engine
