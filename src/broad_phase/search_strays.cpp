// SPDX-License-Identifier: MIT
// CPU twin of search_strays.comp.glsl. Each body is compared with several strays side by side.
#include <algorithm>
#include <array>
#include <atomic>
#include <span>

#include "broad_phase/box_now.h"
#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"

namespace talus::engine {

static bool was_near(const CpuState& state, uint stray, uint body) {
    return is_candidate(state.aabbs[stray], state.aabbs[body]) &&
           !faces_part(state.oriented_boxes[stray], state.oriented_boxes[body]);
}

static void search_strays_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint>& counters = state.counters;
    if (counters[k_counter_search_count] != 0) return;
    const std::span<const uint> strays(state.strays.data, counters[k_counter_stray_count]);
    if (strays.empty()) return;
    std::array<OrientedBox, k_most_strays> oriented;
    std::array<Aabb, k_most_strays> boxes;
    std::ranges::transform(strays, oriented.begin(), [&](uint stray) { return box_with_skin(state, stray); });
    std::transform(oriented.begin(), oriented.begin() + strays.size(), boxes.begin(), compute_aabb);
    SearchMemory& memory = SearchMemory::of(state);
    memory.take_boxes(state, std::span(boxes).first(strays.size()));
    std::vector<bool> is_stray(state.parameters.body_count);
    for (const uint stray : strays)
        is_stray[stray] = true;

    const Array<uint> marks = state.words(launch.bound("StrayMarks"));
    std::fill_n(marks.data, state.parameters.body_count, 0u);
    const auto note_near = [&](uint stray, uint body) {
        std::atomic_ref(marks[stray]).store(k_stray_near, std::memory_order_relaxed);
        const uint place = std::atomic_ref(counters[k_counter_near_pairs]).fetch_add(1);
        if (place < most_stray_pairs(state.parameters.body_count))
            state.near_pairs[place] = make_pair(stray, body);
        else
            std::atomic_ref(counters[k_counter_search_count]).store(state.parameters.body_count);
    };
    state.parallel_parts(state.parameters.body_count, SearchMemory::k_part, [&](uint, uint first, uint end) {
        std::vector<uint> near;
        for (uint body = first; body < end; ++body) {
            const OrientedBox other = is_stray[body] ? box_with_skin(state, body) : state.oriented_boxes[body];
            near.clear();
            memory.find_partners(is_stray[body] ? compute_aabb(other) : state.aabbs[body], 0,
                                 static_cast<uint>(strays.size()), near);
            for (const uint i : near)
                if ((!is_stray[body] || body > strays[i]) && !faces_part(oriented[i], other) &&
                    !was_near(state, strays[i], body))
                    note_near(strays[i], body);
        }
    });
}

const Kernel search_strays{"broad_phase/search_strays", search_strays_on_cpu, 256};

} // namespace talus::engine
