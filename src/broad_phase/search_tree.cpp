// SPDX-License-Identifier: MIT
// CPU twin of search_tree.comp.glsl.
#include <algorithm>

#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void search_tree_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_search_count] == 0) return;
    const Array<uint> partners = state.words(launch.bound("Partners"));
    const bool writing = launch.args[0] == 1;
    const uint top = launch.args[1];
    const uint body_count = state.parameters.body_count;
    const uint end = state.tree_grids[0].end;
    const auto offset_of = [&](uint place) {
        return place < body_count ? state.pair_counts[place] : state.counters[k_counter_found_pairs];
    };
    state.parallel(body_count, [&](uint own) {
        const uint body = state.sort_values[own];
        const uint offset = writing ? offset_of(own) : 0;
        uint found = 0;
        const auto take = [&](uint partner) {
            if (writing && offset + found < state.parameters.pair_capacity)
                state.pairs[offset + found] = make_pair(body, state.sort_values[partner]);
            if (!writing && found < k_kept_partners) partners[found * body_count + own] = partner;
            ++found;
        };
        uint place = own + 1;
        if (writing) {
            const uint count = offset_of(own + 1) - offset;
            while (found < std::min(count, k_kept_partners)) {
                place = partners[found * body_count + own] + 1;
                take(place - 1);
            }
            if (count <= k_kept_partners) return;
        }
        const Aabb box = state.tree_nodes[tree_node(own, 0, top)];
        const OrientedBox oriented = state.oriented_boxes[body];
        uint shift = tree_shift_from(place);
        while (place < end) {
            const bool overlaps = is_candidate(box, state.tree_nodes[tree_node(place, shift, top)]);
            if (overlaps && shift > 0) {
                shift -= k_tree_bits;
                continue;
            }
            if (overlaps && !faces_part(oriented, state.oriented_boxes[state.sort_values[place]])) take(place);
            place += 1u << shift;
            shift = tree_shift_from(place);
        }
        if (!writing) state.pair_counts[own] = found;
    });
}

const Kernel search_tree{"broad_phase/search_tree", search_tree_on_cpu};

} // namespace talus::engine
