// SPDX-License-Identifier: MIT
// CPU twin of mark_awake_pairs.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void mark_awake_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> marks = state.words(launch.bound("Marks"));
    const auto is_in_graph = [&](uint body) {
        return state.islands[body] != k_none || (state.island_fill[body] & k_pressed) != 0;
    };
    for (uint pair = 0; pair < state.counters[k_counter_graph_pairs]; ++pair) {
        const Manifold& manifold = state.manifolds[pair];
        const bool active = is_active(manifold);
        const bool listed = active && (is_in_graph(manifold.body_a) || is_in_graph(manifold.body_b));
        marks[pair] = listed ? 1 : 0;
        if (!active || listed) continue;
        ++state.counters[k_counter_manifold_count];
        ++state.counters[k_counter_sleeping_manifolds];
        state.counters[k_counter_contact_count] += manifold.point_count;
    }
}

const Kernel mark_awake_pairs{"resolution/mark_awake_pairs", mark_awake_pairs_on_cpu, k_count_group};

} // namespace talus::engine
