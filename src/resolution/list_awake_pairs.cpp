// SPDX-License-Identifier: MIT
// CPU twin of list_awake_pairs.comp.glsl.
#include <bit>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void list_awake_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> mark_counts = state.words(launch.bound("MarkCounts")), marks = state.words(launch.bound("Marks"));
    const uint pair_count = state.counters[k_counter_pair_count];
    const uint listed = pair_count > 0 ? state.counters[k_counter_listed_pairs] : 0;
    state.counters[k_counter_graph_pairs] = listed;
    state.dispatches[k_dispatch_graph_pairs] = groups_for(listed, k_group_size);
    state.dispatches[k_dispatch_graph_tiles] = groups_for(listed, k_sort_tile);
    state.dispatches[k_dispatch_graph_counts] = groups_for(listed, k_count_group);
    if (listed == 0) return;
    state.parallel((pair_count + k_mark_group - 1) / k_mark_group, [&](uint group) {
        uint place = mark_counts[group];
        for (uint word = k_mark_words * group; word < k_mark_words * (group + 1); ++word)
            for (uint bits = marks[word]; bits != 0; bits &= bits - 1)
                state.listed_pairs[place++] = 32 * word + static_cast<uint>(std::countr_zero(bits));
    });
}

const Kernel list_awake_pairs{"resolution/list_awake_pairs", list_awake_pairs_on_cpu};

} // namespace talus::engine
