// SPDX-License-Identifier: MIT
// CPU twin of choose_axis.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void choose_axis_on_cpu(CpuState& state, const Launch&) {
    const uint group_count = (state.parameters.body_count + k_spread_group - 1) / k_spread_group;
    SpreadSum sum = empty_spread();
    for (uint group = 0; group < group_count; ++group)
        sum = add_spreads(sum, state.spread_sums[group]);
    state.sweep_axes[0] = choose_sweep_axis(sum, state.parameters.body_count);
}

const Kernel choose_axis{"broad_phase/choose_axis", choose_axis_on_cpu, 1};

} // namespace talus::engine
