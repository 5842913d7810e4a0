// SPDX-License-Identifier: MIT
// CPU twin of search_tree.comp.glsl. Bodies side by side in the order of the tree go through it together. Pairs are
// found when they are counted, and written when their places are known.
#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"
#include "device/cpu/cpu_state.h"

namespace talus::engine {

static void search_tree_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_search_count] == 0) return;
    SearchMemory& memory = SearchMemory::of(state);
    const uint body_count = state.parameters.body_count;
    const bool writing = launch.args[0] == 1;
    if (writing) return memory.write_pairs(state, body_count);

    const TreeView tree{state.tree_nodes.data, state.oriented_boxes.data, state.sort_values.data, launch.args[1],
                        state.tree_grids[0].end};
    memory.begin(body_count);
    state.parallel_parts(body_count, SearchMemory::k_part, [&](uint part, uint first, uint end) {
        std::vector<uint>& partners = memory.partners_of(part);
        partners.clear();
        memory.search_tree(tree, first, end, partners, &state.pair_counts[first]);
    });
}

const Kernel search_tree{"broad_phase/search_tree", search_tree_on_cpu};

} // namespace talus::engine
