// SPDX-License-Identifier: MIT
#include "broad_phase/lane_sweep.h"

#include <algorithm>
#include <array>

#include "device/cpu/instruction_set.h"

namespace talus::engine {

// One a file, as each is compiled for its own instructions.
extern const LaneSweep lane_sweep_base, lane_sweep_avx2;

static const LaneSweep& lane_sweep() {
    return TALUS_FOR_THIS_MACHINE(lane_sweep);
}

void SweepMemory::take_boxes(const CpuState& state, uint count) {
    const LaneSweep& sweep = lane_sweep();
    const std::size_t lines = sweep.batch_bytes / sizeof(Line);
    const uint batches = (count + sweep.lanes - 1) / sweep.lanes;
    boxes_.resize(lines * batches);
    partners_.resize((count + k_part - 1) / k_part);
    state.parallel(batches, [&](uint batch) {
        const uint first = batch * sweep.lanes;
        sweep.take_boxes(&state.sorted_aabbs[first], std::min(sweep.lanes, count - first), &boxes_[lines * batch]);
    });
}

void SweepMemory::find_partners(const Aabb& box, uint first, uint end, std::vector<uint>& partners) const {
    std::array<uint, 256> found;
    for (; first < end; first += static_cast<uint>(found.size())) {
        const uint last = std::min(end, first + static_cast<uint>(found.size()));
        const uint count = lane_sweep().find_partners(box, boxes_.data(), first, last, found.data());
        partners.insert(partners.end(), found.begin(), found.begin() + count);
    }
}

std::size_t SweepMemory::memory_bytes() const {
    std::size_t bytes = boxes_.capacity() * sizeof(Line) + partners_.capacity() * sizeof(partners_[0]);
    for (const std::vector<uint>& part : partners_)
        bytes += part.capacity() * sizeof(uint);
    return bytes;
}

} // namespace talus::engine
