// SPDX-License-Identifier: MIT
// CPU twin of find_known_pairs.comp.glsl. Here the near pairs say which strays these are.
#include <atomic>

#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void find_known_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint>& counters = state.counters;
    if (counters[k_counter_near_pairs] == 0 || counters[k_counter_search_count] != 0) return;
    const Array<uint> marks = state.words(launch.bound("StrayMarks"));
    state.parallel(counters[k_counter_pair_demand], [&](uint entry) {
        const Pair pair = state.pairs[entry];
        if (marks[pair.body_a] != k_stray_near && marks[pair.body_b] != k_stray_near) return;
        const uint place = std::atomic_ref(counters[k_counter_known_pairs]).fetch_add(1);
        if (place < most_stray_pairs(state.parameters.body_count))
            state.known_pairs[place] = pair;
        else
            std::atomic_ref(counters[k_counter_search_count]).store(state.parameters.body_count);
    });
}

const Kernel find_known_pairs{"broad_phase/find_known_pairs", find_known_pairs_on_cpu, 256};

} // namespace talus::engine
