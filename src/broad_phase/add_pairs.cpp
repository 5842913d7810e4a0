// SPDX-License-Identifier: MIT
// CPU twin of add_pairs.comp.glsl.
#include <algorithm>
#include <span>
#include <vector>

#include "broad_phase/box_now.h"
#include "broad_phase/broad_phase.h"

namespace talus::engine {

static void add_pairs_on_cpu(CpuState& state, const Launch&) {
    Array<uint>& counters = state.counters;
    const std::span strays(state.strays.data, counters[k_counter_stray_count]);
    if (strays.empty() || counters[k_counter_search_count] != 0) return;
    const std::span known(state.known_pairs.data, counters[k_counter_known_pairs]);
    const std::span pairs_near(state.near_pairs.data, counters[k_counter_near_pairs]);
    std::ranges::sort(known, comes_before);
    std::vector<Pair> added;
    for (const Pair& pair : pairs_near)
        if (!std::ranges::binary_search(known, pair, comes_before)) added.push_back(pair);
    if (added.size() > k_most_new_pairs) {
        counters[k_counter_search_count] = state.parameters.body_count;
        return;
    }
    std::ranges::sort(added, comes_before);
    const uint list_count = counters[k_counter_pair_demand], new_count = static_cast<uint>(added.size());
    if (list_count + new_count > state.parameters.pair_capacity) {
        counters[k_counter_wanted_pairs] = list_count + new_count;
        counters[k_counter_did_not_fit] |= k_fit_pairs;
        return;
    }
    std::ranges::copy(added, &state.pairs[list_count]);
    counters[k_counter_pair_demand] += new_count;
    counters[k_counter_added_pairs] += new_count;
    for (const uint stray : strays) {
        state.oriented_boxes[stray] = box_with_skin(state, stray);
        state.aabbs[stray] = compute_aabb(state.oriented_boxes[stray]);
    }
}

const Kernel add_pairs{"broad_phase/add_pairs", add_pairs_on_cpu, 1};

} // namespace talus::engine
