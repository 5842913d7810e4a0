// SPDX-License-Identifier: MIT
// CPU twin of choose_grid.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "broad_phase/sum_spread.h"

namespace talus::engine {

static void choose_grid_on_cpu(CpuState& state, const Launch&) {
    if (state.counters[k_counter_search_count] == 0) return;
    state.tree_grids[0] = choose_tree_grid(sum_spread(state), state.parameters.body_count);
}

const Kernel choose_grid{"broad_phase/choose_grid", choose_grid_on_cpu, 1};

} // namespace talus::engine
