// SPDX-License-Identifier: MIT
// CPU twin of sweep_pairs.comp.glsl. Pairs are found when they are counted, and written when their places are known.
#include <algorithm>

#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

void count_partners(CpuState& state, SearchMemory& memory, uint body_count) {
    const SweepAxis axis = state.sweep_axes[0];
    const Aabb* const boxes = state.sorted_aabbs.data;
    memory.begin(body_count);
    memory.take_boxes(state, {boxes, body_count});
    state.parallel_parts(body_count, SearchMemory::k_part, [&](uint part, uint first, uint end) {
        std::vector<uint>& partners = memory.partners_of(part);
        std::vector<uint> places; // that these are partners of
        partners.clear();
        uint beyond = first; // the first that begins where a box has ended
        for (uint place = first; place < end; ++place) {
            const Aabb& box = boxes[place];
            const float limit = component(box.upper, axis.axis);
            const uint next = place + 1, first_large = std::max(axis.first_large, next);
            const auto begins_beyond = [&](uint other) { return component(boxes[other].lower, axis.axis) > limit; };
            // Near that of the place before, as what is far larger than others comes behind first_large; processors
            // mispredict each step of a search by halves.
            beyond = std::clamp(beyond, next, first_large);
            while (beyond < first_large && !begins_beyond(beyond))
                ++beyond;
            while (beyond > next && begins_beyond(beyond - 1))
                --beyond;
            memory.find_partners(box, next, beyond, partners);
            memory.find_partners(box, first_large, axis.end, partners);
            places.resize(partners.size(), place);
        }
        memory.keep_unparted({state.oriented_boxes.data, state.sort_values.data}, places, partners);
        std::fill(&state.pair_counts[first], &state.pair_counts[end], 0u);
        for (const uint place : places)
            ++state.pair_counts[place];
    });
}

void sweep_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const uint body_count = state.counters[k_counter_search_count];
    const bool writing = launch.args[0] == 1;
    SearchMemory& memory = SearchMemory::of(state);
    if (writing)
        memory.write_pairs(state, body_count);
    else
        count_partners(state, memory, body_count);
}

} // namespace

const Kernel sweep_pairs{"broad_phase/sweep_pairs", sweep_pairs_on_cpu};

} // namespace talus::engine
