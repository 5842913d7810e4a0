// SPDX-License-Identifier: MIT
// CPU twin of test_all_pairs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void test_all_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const uint body_count = state.counters[k_counter_search_count];
    const bool writing = launch.args[0] == 1;
    state.parallel(body_count, [&](uint body) {
        const uint offset = writing ? state.pair_counts[body] : 0;
        uint found = 0;
        for (uint other = body + 1; other < body_count; ++other) {
            if (!is_candidate(state.aabbs[body], state.aabbs[other])) continue;
            if (faces_part(state.oriented_boxes[body], state.oriented_boxes[other])) continue;
            if (writing && offset + found < state.parameters.pair_capacity)
                state.pairs[offset + found] = make_pair(body, other);
            ++found;
        }
        if (!writing) state.pair_counts[body] = found;
    });
}

const Kernel test_all_pairs{"broad_phase/test_all_pairs", test_all_pairs_on_cpu};

} // namespace talus::engine
