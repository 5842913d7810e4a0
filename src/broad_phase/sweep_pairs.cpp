// SPDX-License-Identifier: MIT
// CPU twin of sweep_pairs.comp.glsl. Pairs are found when they are counted, and written when their places are known.
#include <algorithm>

#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_sweep.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

constexpr uint k_part = SweepMemory::k_part;

/// Calls part(index, first, end) for parts of the places below `count`.
template <typename Part> void for_each_part_of(const CpuState& state, uint count, const Part& part) {
    const auto call = [&](uint index) { part(index, index * k_part, std::min((index + 1) * k_part, count)); };
    state.parallel((count + k_part - 1) / k_part, call, k_parallel_grain / k_part);
}

void count_partners(CpuState& state, SweepMemory& memory, uint body_count) {
    const SweepAxis axis = state.sweep_axes[0];
    const Aabb* const boxes = state.sorted_aabbs.data;
    memory.take_boxes(state, body_count);
    for_each_part_of(state, body_count, [&](uint part, uint first, uint end) {
        std::vector<uint>& partners = memory.partners_of(part);
        partners.clear();
        for (uint place = first; place < end; ++place) {
            const Aabb& box = boxes[place];
            const float limit = component(box.upper, axis.axis);
            const uint next = place + 1, first_large = std::max(axis.first_large, next);
            const Aabb* const beyond = std::partition_point(boxes + next, boxes + first_large, [&](const Aabb& other) {
                return component(other.lower, axis.axis) <= limit;
            });
            const std::size_t before = partners.size();
            memory.find_partners(box, next, static_cast<uint>(beyond - boxes), partners);
            memory.find_partners(box, first_large, axis.end, partners);
            const OrientedBox& oriented = state.oriented_boxes[state.sort_values[place]];
            const auto parted = [&](uint partner) {
                return faces_part(oriented, state.oriented_boxes[state.sort_values[partner]]);
            };
            partners.erase(
                std::remove_if(partners.begin() + static_cast<std::ptrdiff_t>(before), partners.end(), parted),
                partners.end());
            state.pair_counts[place] = static_cast<uint>(partners.size() - before);
        }
    });
}

void write_pairs(CpuState& state, SweepMemory& memory, uint body_count) {
    const auto offset_of = [&](uint place) {
        return place < body_count ? state.pair_counts[place] : state.counters[k_counter_found_pairs];
    };
    for_each_part_of(state, body_count, [&](uint part, uint first, uint end) {
        const uint* partner = memory.partners_of(part).data();
        for (uint place = first; place < end; ++place) {
            const uint body = state.sort_values[place];
            for (uint pair = offset_of(place), last = offset_of(place + 1); pair < last; ++pair, ++partner)
                if (pair < state.parameters.pair_capacity)
                    state.pairs[pair] = make_pair(body, state.sort_values[*partner]);
        }
    });
}

void sweep_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const uint body_count = state.counters[k_counter_search_count];
    const bool writing = launch.args[0] == 1;
    if (state.sweep_memory == nullptr) state.sweep_memory = std::make_shared<SweepMemory>();
    if (writing)
        write_pairs(state, *state.sweep_memory, body_count);
    else
        count_partners(state, *state.sweep_memory, body_count);
}

} // namespace

const Kernel sweep_pairs{"broad_phase/sweep_pairs", sweep_pairs_on_cpu};

} // namespace talus::engine
