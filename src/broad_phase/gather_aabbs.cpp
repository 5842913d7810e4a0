// SPDX-License-Identifier: MIT
// CPU twin of gather_aabbs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void gather_aabbs_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_search_count], [&](uint place) {
        state.sorted_aabbs[place] = state.aabbs[state.sort_values[place]];
        const uint key = state.sort_keys[place];
        const uint key_before = place > 0 ? state.sort_keys[place - 1] : 0;
        if (is_first_from(k_large_key, key, key_before)) state.sweep_axes[0].first_large = place;
        if (is_first_from(k_absent_key, key, key_before)) state.sweep_axes[0].end = place;
    });
}

const Kernel gather_aabbs{"broad_phase/gather_aabbs", gather_aabbs_on_cpu};

} // namespace talus::engine
