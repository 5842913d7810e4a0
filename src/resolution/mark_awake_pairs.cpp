// SPDX-License-Identifier: MIT
// CPU twin of mark_awake_pairs.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void mark_awake_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> mark_counts = state.words(launch.bound("MarkCounts")), marks = state.words(launch.bound("Marks"));
    const auto is_in_graph = [&](uint body) {
        return state.islands[body] != k_none || (state.island_fill[body] & k_pressed) != 0;
    };
    const uint pair_count = state.counters[k_counter_graph_pairs],
               groups = (pair_count + k_mark_group - 1) / k_mark_group;
    std::fill_n(mark_counts.data, groups, 0u);
    std::fill_n(marks.data, std::size_t{k_mark_words} * groups, 0u);
    for (uint pair = 0; pair < pair_count; ++pair) {
        const Manifold& manifold = state.manifolds[pair];
        const bool active = is_active(manifold);
        const bool listed = active && (is_in_graph(manifold.body_a) || is_in_graph(manifold.body_b));
        if (listed) {
            ++mark_counts[pair / k_mark_group];
            marks[pair / 32] |= 1u << (pair % 32);
        }
        if (!active || listed) continue;
        ++state.counters[k_counter_manifold_count];
        ++state.counters[k_counter_sleeping_manifolds];
        state.counters[k_counter_contact_count] += manifold.point_count;
    }
}

const Kernel mark_awake_pairs{"resolution/mark_awake_pairs", mark_awake_pairs_on_cpu, k_count_group};

} // namespace talus::engine
