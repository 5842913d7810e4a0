// SPDX-License-Identifier: MIT
// CPU twin of find_strays.comp.glsl.
#include <atomic>
#include <bit>

#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"

namespace talus::engine {

static void note_who_is_awake(CpuState& state) {
    state.parallel(state.parameters.body_count, [&](uint body) {
        const std::atomic_ref awake(state.counters[k_counter_awake]);
        if (awake.load(std::memory_order_relaxed) == 0 &&
            is_awake(state.poses[body], state.velocities[body], state.shapes[body], state.parameters))
            awake.store(1, std::memory_order_relaxed);
    });
}

static void find_strays_on_cpu(CpuState& state, const Launch& launch) {
    Array<uint>& counters = state.counters;
    if (counters[k_counter_did_not_fit] != 0) return;
    const uint body_count = state.parameters.body_count;
    if (state.parameters.rest_steps > 0) note_who_is_awake(state);
    const bool other_list = counters[k_counter_searched_slots] != body_count;
    const bool takes_all = other_list || has_aged(counters[k_counter_added_pairs], counters[k_counter_pair_demand],
                                                  counters[k_counter_all_strays], body_count);
    const uint most = most_strays(body_count, launch.args[0] == 1);
    std::atomic<uint> count = other_list ? most + 1 : 0;
    const LaneSearch& search = lane_search();
    state.parallel_parts(other_list ? 0 : body_count, search.lanes, [&](uint, uint first, uint end) {
        if (count.load(std::memory_order_relaxed) > most) return;
        for (uint strays = search.find_strays(state, first, end - first); strays != 0; strays &= strays - 1) {
            const uint place = takes_all ? most : count.fetch_add(1, std::memory_order_relaxed);
            if (place < most)
                state.strays[place] = first + static_cast<uint>(std::countr_zero(strays));
            else
                count.store(most + 1, std::memory_order_relaxed);
        }
    });
    if (count > most) {
        counters[k_counter_search_count] = body_count;
        return;
    }
    counters[k_counter_stray_count] = count;
    if (count == 0) return;
    const Array<uint> marks = state.words(launch.bound("StrayMarks"));
    std::fill_n(marks.data, body_count, 0u);
    for (uint i = 0; i < count; ++i)
        marks[state.strays[i]] = k_stray;
    std::fill_n(state.near_table.data, near_table_size(body_count), k_none);
}

const Kernel find_strays{"broad_phase/find_strays", find_strays_on_cpu};

} // namespace talus::engine
