// SPDX-License-Identifier: MIT
// CPU twin of search_tree.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void search_tree_on_cpu(CpuState& state, const Launch& launch) {
    const bool writing = launch.args[0] == 1;
    const uint top = launch.args[1];
    const uint end = state.tree_grids[0].end;
    state.parallel(state.parameters.body_count, [&](uint own) {
        const uint body = state.sort_values[own];
        const Aabb box = state.tree_nodes[tree_node(own, 0, top)];
        const uint offset = writing ? state.pair_counts[own] : 0;
        uint found = 0;
        uint place = own + 1;
        uint shift = tree_shift_from(place);
        while (place < end) {
            const bool overlaps = is_candidate(box, state.tree_nodes[tree_node(place, shift, top)]);
            if (overlaps && shift > 0) {
                shift -= k_tree_bits;
                continue;
            }
            if (overlaps) {
                if (writing && offset + found < state.parameters.pair_capacity)
                    state.pairs[offset + found] = make_pair(body, state.sort_values[place]);
                ++found;
            }
            place += 1u << shift;
            shift = tree_shift_from(place);
        }
        if (!writing) state.pair_counts[own] = found;
    });
}

const Kernel search_tree{"broad_phase/search_tree", search_tree_on_cpu};

} // namespace talus::engine
