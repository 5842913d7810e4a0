// SPDX-License-Identifier: MIT
// CPU twin of write_sort_keys.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void write_sort_keys_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_search_count], [&](uint body) {
        state.sort_keys[body] = sweep_key(state.aabbs[body], state.sweep_axes[0]);
        state.sort_values[body] = body;
    });
}

const Kernel write_sort_keys{"broad_phase/write_sort_keys", write_sort_keys_on_cpu};

} // namespace talus::engine
