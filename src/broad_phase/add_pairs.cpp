// SPDX-License-Identifier: MIT
// CPU twin of add_pairs.comp.glsl.
#include <algorithm>
#include <span>
#include <vector>

#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void add_pairs_on_cpu(CpuState& state, const Launch&) {
    Array<uint>& counters = state.counters;
    if (counters[k_counter_near_pairs] == 0 || counters[k_counter_search_count] != 0) return;
    std::vector<Pair> added;
    std::ranges::remove_copy_if(std::span(state.near_pairs.data, counters[k_counter_near_pairs]),
                                std::back_inserter(added), is_known);
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
}

const Kernel add_pairs{"broad_phase/add_pairs", add_pairs_on_cpu, 1};

} // namespace talus::engine
