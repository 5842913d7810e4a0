// SPDX-License-Identifier: MIT
// CPU twin of list_awake_pairs.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void list_awake_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> marks = state.words(launch.bound("Marks"));
    const uint pair_count = state.counters[k_counter_pair_count];
    const uint listed = pair_count > 0 ? state.counters[k_counter_listed_pairs] : 0;
    state.counters[k_counter_graph_pairs] = listed;
    state.dispatches[k_dispatch_graph_pairs] = groups_for(listed, k_group_size);
    state.dispatches[k_dispatch_graph_tiles] = groups_for(listed, k_sort_tile);
    state.dispatches[k_dispatch_graph_counts] = groups_for(listed, k_count_group);
    state.parallel(pair_count, [&](uint pair) {
        const uint place = marks[pair], next = pair + 1 < pair_count ? marks[pair + 1] : listed;
        if (place != next) state.manifold_order[place] = pair;
    });
}

const Kernel list_awake_pairs{"resolution/list_awake_pairs", list_awake_pairs_on_cpu};

} // namespace talus::engine
