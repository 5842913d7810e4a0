// SPDX-License-Identifier: MIT
// CPU twin of search_strays.comp.glsl. Strays side by side go through the tree together, each to its end.
#include <algorithm>
#include <array>
#include <bit>

#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"
#include "broad_phase/note_near.h"
#include "device/cpu/instruction_set.h"

namespace talus::engine {

static void search_strays_on_cpu(CpuState& state, const Launch& launch) {
    const uint count = strays_in_tree(state.counters[k_counter_stray_count], state.counters[k_counter_search_count]);
    if (count == 0) return;
    const uint body_count = state.parameters.body_count, first_shift = launch.args[0], top = launch.args[1];
    const TreeView tree{state.tree_nodes.data, state.oriented_boxes.data, state.sort_values.data, top, body_count};
    const StraySearch search{state, state.words(launch.bound("StrayMarks"))};
    std::sort(state.strays.data, state.strays.data + count); // they are in any order; neighbours take much the same way
    struct Group {
        const StraySearch& search;
        const TreeView& tree;
        const uint* strays;
        std::array<OrientedBox, k_most_lanes> oriented;
    };
    const TakePartner take = [](void* context, uint place, uint lanes) {
        const Group& group = *static_cast<const Group*>(context);
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            group.search.look_at(group.strays[lane], group.oriented[lane], group.tree.bodies[place]);
        }
    };
    const uint width = lane_search().lanes;
    state.parallel_parts(count, width, [&](uint, uint first, uint end) {
        Group group{search, tree, state.strays.data + first, {}};
        std::array<Aabb, k_most_lanes> boxes;
        for (uint lane = 0; lane < end - first; ++lane) {
            group.oriented[lane] = box_with_skin(state, group.strays[lane]);
            boxes[lane] = compute_aabb(group.oriented[lane]);
        }
        lane_search().search_tree_for(tree, first_shift, boxes.data(), end - first, take, &group);
    });
}

const Kernel search_strays{"broad_phase/search_strays", search_strays_on_cpu, k_strays_a_group};

} // namespace talus::engine
