// SPDX-License-Identifier: MIT
// CPU twin of sweep_pairs.comp.glsl.
#include <algorithm>

#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void sweep_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const uint body_count = state.counters[k_counter_search_count];
    const bool writing = launch.args[0] == 1;
    const uint axis = state.sweep_axes[0].axis;
    const uint first_large = state.sweep_axes[0].first_large;
    const uint end = state.sweep_axes[0].end;

    const auto sweep = [&](uint place) {
        const uint body = state.sort_values[place];
        const Aabb box = state.sorted_aabbs[place];
        const uint offset = writing ? state.pair_counts[place] : 0;
        uint found = 0;
        const auto test = [&](uint other) {
            if (!is_candidate(box, state.sorted_aabbs[other])) return;
            if (writing && offset + found < state.parameters.pair_capacity)
                state.pairs[offset + found] = make_pair(body, state.sort_values[other]);
            ++found;
        };
        for (uint i = place + 1; i < first_large; ++i) {
            if (component(state.sorted_aabbs[i].lower, axis) > component(box.upper, axis)) break;
            test(i);
        }
        for (uint i = std::max(first_large, place + 1); i < end; ++i)
            test(i);
        if (!writing) state.pair_counts[place] = found;
    };
    state.parallel(body_count, sweep);
}

const Kernel sweep_pairs{"broad_phase/sweep_pairs", sweep_pairs_on_cpu};

} // namespace talus::engine
