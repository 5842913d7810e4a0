// SPDX-License-Identifier: MIT
// CPU twin of join_islands.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/island_roots.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void ask_for_substeps(CpuState& state, uint body, uint demand) {
    state.substeps[body] = max(state.substeps[body], substeps_of(demand));
    state.island_sizes[body] = max(state.island_sizes[body], foot_rate_of(demand) << k_foot_rate_shift);
    if (is_in_tall_column(demand)) state.island_fill[body] |= k_tall;
}

static void join_islands_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint>& islands = state.islands;
    Array<uint>& fill = state.island_fill;
    for (uint entry = 0; entry < state.counters[k_counter_graph_pairs]; ++entry) {
        if (!is_in_part(entry / k_group_size, launch.args[1])) continue;
        const uint pair = launch.args[0] == k_join_awake ? state.listed_pairs[entry] : entry;
        const Manifold& manifold = state.manifolds[pair];
        const uint a = manifold.body_a, b = manifold.body_b;
        const auto is_quiet = [&](uint body) { return (fill[body] & k_quiet) != 0; };
        if (launch.args[0] == k_join_to_sleep && is_quiet(a) && is_quiet(b)) continue;
        if (!is_active(manifold)) continue;
        const bool pushes_a = islands[a] != k_none, pushes_b = islands[b] != k_none;
        if (launch.args[0] == k_join_to_sleep) {
            if ((fill[a] & k_restless) != 0) fill[b] |= k_touched;
            if ((fill[b] & k_restless) != 0) fill[a] |= k_touched;
            if (is_quiet(a)) fill[a] |= k_reached;
            if (is_quiet(b)) fill[b] |= k_reached;
        }
        if (launch.args[0] != k_join_awake) {
            if (pushes_a) ask_for_substeps(state, a, manifold.demand);
            if (pushes_b) ask_for_substeps(state, b, manifold.demand);
        }
        if (pushes_a && pushes_b) join_islands_of(islands, a, b, order_of_root);
    }
}

const Kernel join_islands{"resolution/join_islands", join_islands_on_cpu};

} // namespace talus::engine
