// SPDX-License-Identifier: MIT
// PairsToCollide on the CPU: each part of the pairs has a list of its own, where its pairs would be, in their order.
#pragma once

#include "device/cpu/cpu_state.h"

namespace talus::engine {

/// Pairs that a thread treats together.
inline constexpr uint k_pairs_a_part = 64;

/// A part's list. Its entries are the kernel's; k_none ends it where it has fewer than the part has pairs.
class PartList {
public:
    /// `first`, `end`: the part's pairs.
    PartList(const Array<uint>& words, uint first, uint end) : entries_(&words[first]), room_(end - first) {}

    void add(uint entry) { entries_[count_++] = entry; }
    /// Returns how many there are.
    uint close() {
        if (count_ < room_) entries_[count_] = k_none;
        return count_;
    }
    /// The next one to be read; k_none: there is none.
    uint next() { return count_ < room_ ? entries_[count_++] : k_none; }

private:
    uint* entries_;
    uint room_;
    uint count_ = 0; ///< written, or read
};

} // namespace talus::engine
