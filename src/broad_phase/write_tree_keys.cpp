// SPDX-License-Identifier: MIT
// CPU twin of write_tree_keys.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void write_tree_keys_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_search_count], [&](uint body) {
        state.sort_keys[body] = tree_key(state.aabbs[body], state.tree_grids[0]);
        state.sort_values[body] = body;
    });
}

const Kernel write_tree_keys{"broad_phase/write_tree_keys", write_tree_keys_on_cpu};

} // namespace talus::engine
