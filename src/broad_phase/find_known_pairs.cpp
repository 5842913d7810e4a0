// SPDX-License-Identifier: MIT
// CPU twin of find_known_pairs.comp.glsl.
#include <atomic>

#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void find_known_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint>& counters = state.counters;
    if (counters[k_counter_near_pairs] == 0 || counters[k_counter_search_count] != 0) return;
    const Array<uint> marks = state.words(launch.bound("StrayMarks"));
    const uint last = near_table_size(state.parameters.body_count) - 1;
    state.parallel(counters[k_counter_pair_demand], [&](uint entry) {
        const Pair pair = state.pairs[entry];
        if (marks[pair.body_a] != k_stray_near && marks[pair.body_b] != k_stray_near) return;
        for (uint slot = hash_pair(pair.body_a, pair.body_b) & last;; slot = (slot + 1) & last) {
            const uint place = state.near_table[slot];
            if (place == k_none) return;
            Pair& near = state.near_pairs[place];
            const std::atomic_ref body_a(near.body_a); // another thread may say of another pair that it is known
            if (near.body_b != pair.body_b || body_a.load(std::memory_order_relaxed) != pair.body_a) continue;
            return body_a.store(k_none, std::memory_order_relaxed);
        }
    });
}

const Kernel find_known_pairs{"broad_phase/find_known_pairs", find_known_pairs_on_cpu, 256};

} // namespace talus::engine
