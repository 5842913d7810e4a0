// SPDX-License-Identifier: MIT
// CPU twin of choose_grid.comp.glsl.
#include <array>

#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void choose_grid_on_cpu(CpuState& state, const Launch&) {
    const uint group_count = (state.parameters.body_count + k_spread_group - 1) / k_spread_group;
    std::array<SpreadSum, k_spread_group> sums;
    sums.fill(empty_spread());
    for (uint group = 0; group < group_count; ++group) {
        SpreadSum& sum = sums[group % k_spread_group];
        sum = add_spreads(sum, state.spread_sums[group]);
    }
    for (uint half_size = k_spread_group / 2; half_size > 0; half_size /= 2)
        for (uint i = 0; i < half_size; ++i)
            sums[i] = add_spreads(sums[i], sums[i + half_size]);
    state.tree_grids[0] = choose_tree_grid(sums[0], state.parameters.body_count);
}

const Kernel choose_grid{"broad_phase/choose_grid", choose_grid_on_cpu, 1};

} // namespace talus::engine
