// SPDX-License-Identifier: MIT
// A bounding box against several others side by side: one in each lane of the CPU's vector registers.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

struct LaneSweep {
    uint lanes;              ///< boxes side by side
    std::size_t batch_bytes; ///< of as many boxes in the form of lanes
    /// Makes a batch of at most as many boxes as there are lanes.
    void (*take_boxes)(const Aabb* boxes, uint count, void* batch);
    /// Writes which of the boxes `first` to `end` - 1 are candidates to `partners`, in order, and returns how many.
    uint (*find_partners)(const Aabb&, const void* batches, uint first, uint end, uint* partners);
};

/// What the launches of a search keep: the boxes in the form of lanes, and the partners that were found when they were
/// counted.
class SweepMemory {
public:
    static constexpr uint k_part = 32; ///< places whose partners lie together

    /// For as many boxes as there are places.
    void take_boxes(const CpuState&, uint count);
    /// Appends the places of those from `first` to `end` - 1 that are candidates.
    void find_partners(const Aabb&, uint first, uint end, std::vector<uint>& partners) const;
    /// Of the places from `part` k_part on, one place after the other.
    std::vector<uint>& partners_of(uint part) { return partners_[part]; }
    std::size_t memory_bytes() const;

private:
    struct alignas(64) Line {
        std::byte bytes[64];
    };

    std::vector<Line> boxes_;
    std::vector<std::vector<uint>> partners_;
};

} // namespace talus::engine
