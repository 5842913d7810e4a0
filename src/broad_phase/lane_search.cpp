// SPDX-License-Identifier: MIT
#include "broad_phase/lane_search.h"

#include <algorithm>
#include <array>
#include <bit>

#include "device/cpu/instruction_set.h"

namespace talus::engine {

TALUS_DECLARE_OF_SETS(LaneSearch, lane_search);

const LaneSearch& lane_search() {
    return TALUS_FOR_THIS_MACHINE(lane_search);
}

SearchMemory& SearchMemory::of(CpuState& state) {
    if (state.search_memory == nullptr) state.search_memory = std::make_shared<SearchMemory>();
    return *state.search_memory;
}

void SearchMemory::take_boxes(const CpuState& state, std::span<const Aabb> boxes) {
    const LaneSearch& search = lane_search();
    const std::size_t lines = search.batch_bytes / sizeof(Line);
    const auto count = static_cast<uint>(boxes.size());
    boxes_.resize(lines * ((count + search.lanes - 1) / search.lanes));
    const auto take = [&](uint batch, uint first, uint end) {
        search.take_boxes(&boxes[first], end - first, &boxes_[lines * batch]);
    };
    state.parallel_parts(count, search.lanes, take, k_parallel_grain * search.lanes);
}

void SearchMemory::find_partners(const Aabb& box, uint first, uint end, std::vector<uint>& partners) const {
    std::array<uint, 256> found;
    for (; first < end; first += static_cast<uint>(found.size())) {
        const uint last = std::min(end, first + static_cast<uint>(found.size()));
        const uint count = lane_search().find_partners(box, boxes_.data(), first, last, found.data());
        partners.insert(partners.end(), found.begin(), found.begin() + count);
    }
}

void SearchMemory::keep_unparted(const PlacesView& view, std::vector<uint>& places, std::vector<uint>& partners) const {
    const uint lanes = lane_search().lanes;
    const std::size_t count = places.size();
    std::size_t kept = 0;
    for (const auto list : {&places, &partners}) // with what fills the last register
        list->resize((count + lanes - 1) / lanes * lanes, list->empty() ? 0 : list->front());
    for (std::size_t first = 0; first < count; first += lanes) {
        const uint parted = lane_search().find_parted(view, &places[first], &partners[first]);
        for (std::size_t i = first; i < std::min(first + lanes, count); ++i) {
            if ((parted >> (i - first) & 1u) != 0) continue;
            places[kept] = places[i];
            partners[kept++] = partners[i];
        }
    }
    places.resize(kept);
    partners.resize(kept);
}

void SearchMemory::search_tree(const TreeView& tree, uint first, uint end, std::vector<uint>& partners,
                               uint* counts) const {
    using Found = std::array<std::vector<uint>, k_most_lanes>;
    const TakePartner take = [](void* found, uint place, uint lanes) {
        for (; lanes != 0; lanes &= lanes - 1)
            (*static_cast<Found*>(found))[static_cast<std::size_t>(std::countr_zero(lanes))].push_back(place);
    };
    Found found;
    for (; first < end; first += lane_search().lanes) {
        const uint count = std::min(lane_search().lanes, end - first);
        lane_search().search_tree(tree, first, count, take, &found);
        for (uint lane = 0; lane < count; ++lane) {
            *counts++ = static_cast<uint>(found[lane].size());
            partners.insert(partners.end(), found[lane].begin(), found[lane].end());
            found[lane].clear();
        }
    }
}

void SearchMemory::write_pairs(CpuState& state, uint count) const {
    const auto offset_of = [&](uint place) {
        return place < count ? state.pair_counts[place] : state.counters[k_counter_found_pairs];
    };
    state.parallel_parts(count, k_part, [&](uint part, uint first, uint end) {
        const uint* partner = partners_[part].data();
        for (uint place = first; place < end; ++place) {
            const uint body = state.sort_values[place];
            for (uint pair = offset_of(place), last = offset_of(place + 1); pair < last; ++pair, ++partner)
                if (pair < state.parameters.pair_capacity)
                    state.pairs[pair] = make_pair(body, state.sort_values[*partner]);
        }
    });
}

std::size_t SearchMemory::memory_bytes() const {
    std::size_t bytes = boxes_.capacity() * sizeof(Line) + partners_.capacity() * sizeof(partners_[0]);
    for (const std::vector<uint>& part : partners_)
        bytes += part.capacity() * sizeof(uint);
    return bytes;
}

} // namespace talus::engine
