// SPDX-License-Identifier: MIT
// LaneSweep for one set of instructions. Included once by each lane_sweep_*.cpp.
#pragma once

#include "broad_phase/lane_sweep.h"
#include "device/cpu/lane_formulas.h"

namespace talus::engine::TALUS_LANES_NAME {

static_assert(sizeof(Aabb) % 64 == 0, "lines of SweepMemory");

inline void take_boxes(const engine::Aabb* boxes, std::uint32_t count, void* memory) {
    std::uint32_t places[k_lanes];
    for (std::uint32_t lane = 0; lane < k_lanes; ++lane)
        places[lane] = lane < count ? lane : 0;
    const auto lower = gather(boxes, places, 0), upper = gather(boxes, places, 1);
    *static_cast<Aabb*>(memory) = {three_of(lower), lower.w, three_of(upper), floatBitsToUint(upper.w)};
}

inline std::uint32_t find_partners(const engine::Aabb& box, const void* memory, std::uint32_t first, std::uint32_t end,
                                   std::uint32_t* partners) {
    const Aabb* const batches = static_cast<const Aabb*>(memory);
    const Aabb own{box.lower, box.margin, box.upper, box.movable};
    std::uint32_t count = 0;
    for (std::uint32_t batch = first / k_lanes; batch * k_lanes < end; ++batch) {
        const std::uint32_t place = batch * k_lanes;
        std::uint32_t found = bits_of(is_candidate(own, batches[batch]));
        if (place < first) found &= k_lane_mask << (first - place);
        if (end - place < k_lanes) found &= (1u << (end - place)) - 1u;
        for (; found != 0; found &= found - 1)
            partners[count++] = place + static_cast<std::uint32_t>(__builtin_ctz(found));
    }
    return count;
}

} // namespace talus::engine::TALUS_LANES_NAME
