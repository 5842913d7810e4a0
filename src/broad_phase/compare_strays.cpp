// SPDX-License-Identifier: MIT
// CPU twin of compare_strays.comp.glsl. Each body is compared with several strays side by side. Those that have
// searched the tree have left none.
#include <algorithm>
#include <array>
#include <span>

#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"
#include "broad_phase/note_near.h"

namespace talus::engine {

static void compare_strays_on_cpu(CpuState& state, const Launch& launch) {
    const std::span strays(state.strays.data, state.counters[k_counter_stray_count]);
    const uint search_count = state.counters[k_counter_search_count];
    const bool searched_tree =
        launch.args[0] == 1 && strays_in_tree(static_cast<uint>(strays.size()), search_count) > 0;
    if (search_count != 0 || strays.empty() || searched_tree) return;
    std::array<OrientedBox, k_compared_strays> oriented;
    std::array<Aabb, k_compared_strays> boxes;
    std::ranges::transform(strays, oriented.begin(), [&](uint stray) { return box_with_skin(state, stray); });
    std::transform(oriented.begin(), oriented.begin() + strays.size(), boxes.begin(), compute_aabb);
    SearchMemory& memory = SearchMemory::of(state);
    memory.take_boxes(state, std::span(boxes).first(strays.size()));
    const StraySearch search{state, state.words(launch.bound("StrayMarks"))};
    state.parallel_parts(state.parameters.body_count, SearchMemory::k_part, [&](uint, uint first, uint end) {
        std::vector<uint> near;
        for (uint body = first; body < end; ++body) {
            near.clear();
            const Aabb box = search.is_stray(body) ? compute_aabb(box_with_skin(state, body)) : state.aabbs[body];
            memory.find_partners(box, 0, static_cast<uint>(strays.size()), near);
            for (const uint i : near)
                search.look_at(strays[i], oriented[i], body);
        }
    });
}

const Kernel compare_strays{"broad_phase/compare_strays", compare_strays_on_cpu, 256};

} // namespace talus::engine
