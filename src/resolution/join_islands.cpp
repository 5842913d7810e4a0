// SPDX-License-Identifier: MIT
// CPU twin of join_islands.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/island_roots.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void join_islands_on_cpu(CpuState& state, const Launch&) {
    const Array<uint>& islands = state.islands;
    for (uint pair = 0; pair < state.counters[k_counter_graph_pairs]; ++pair) {
        const Manifold& manifold = state.manifolds[pair];
        const uint a = manifold.body_a, b = manifold.body_b;
        if (!is_active(manifold)) continue;
        if (islands[a] != k_none) state.substeps[a] = max(state.substeps[a], substeps_of(manifold.demand));
        if (islands[b] != k_none) state.substeps[b] = max(state.substeps[b], substeps_of(manifold.demand));
        if (islands[a] == k_none && state.island_fill[a] == k_awake) state.island_fill[b] = k_awake;
        if (islands[b] == k_none && state.island_fill[b] == k_awake) state.island_fill[a] = k_awake;
        if (islands[a] == k_none || islands[b] == k_none) continue;
        if (tallness(manifold.demand) == 1) state.island_sizes[a] = k_tall;
        join_islands_of(islands, a, b, order_of_root);
    }
}

const Kernel join_islands{"resolution/join_islands", join_islands_on_cpu};

} // namespace talus::engine
