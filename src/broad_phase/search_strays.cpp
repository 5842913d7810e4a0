// SPDX-License-Identifier: MIT
// CPU twin of search_strays.comp.glsl.
#include <algorithm>
#include <span>

#include "broad_phase/box_now.h"
#include "broad_phase/broad_phase.h"

namespace talus::engine {

static_assert(k_most_strays <= k_group_size, "an invocation of a group for each stray");

static void search_strays_on_cpu(CpuState& state, const Launch&) {
    Array<uint>& counters = state.counters;
    if (counters[k_counter_search_count] != 0) return;
    const std::span strays(state.strays.data, counters[k_counter_stray_count]);
    if (strays.empty()) return;
    const auto is_stray = [&](uint body) { return std::ranges::find(strays, body) != strays.end(); };
    const auto note = [&](Array<Pair>& list, uint counter, Pair pair) {
        const uint place = counters[counter]++;
        if (place < k_most_stray_pairs)
            list[place] = pair;
        else
            counters[k_counter_search_count] = state.parameters.body_count;
    };
    for (const uint stray : strays) {
        const OrientedBox oriented = box_with_skin(state, stray);
        const Aabb box = compute_aabb(oriented);
        for (uint body = 0; body < state.parameters.body_count; ++body) {
            const bool strays_too = is_stray(body);
            if (strays_too && body <= stray) continue;
            const OrientedBox other = strays_too ? box_with_skin(state, body) : state.oriented_boxes[body];
            const Aabb other_box = strays_too ? compute_aabb(other) : state.aabbs[body];
            if (is_candidate(box, other_box) && !faces_part(oriented, other))
                note(state.near_pairs, k_counter_near_pairs, make_pair(stray, body));
        }
    }
    for (uint i = 0; i < counters[k_counter_pair_demand]; ++i) {
        const Pair pair = state.pairs[i];
        if (is_stray(pair.body_a) || is_stray(pair.body_b)) note(state.known_pairs, k_counter_known_pairs, pair);
    }
}

const Kernel search_strays{"broad_phase/search_strays", search_strays_on_cpu};

} // namespace talus::engine
