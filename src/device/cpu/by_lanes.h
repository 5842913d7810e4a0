// SPDX-License-Identifier: MIT
// Items of any number, as many at a time as there are lanes. Not for files that are compiled for a set of instructions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "device/cpu/instruction_set.h"

namespace talus::engine {

/// Of items that fill no register: with the first of them again in the lanes that are left.
template <typename T> std::array<T, k_most_lanes> filled_up(const T* first, const T* end) {
    std::array<T, k_most_lanes> all;
    all.fill(*first);
    std::copy(first, end, all.begin());
    return all;
}

/// Calls `treat` for at most 64 items, as many at a time as there are lanes, with a bit for each lane that has one.
/// Returns what it returns of each, a bit an item.
template <typename T, typename Treat>
std::uint64_t by_lanes(std::uint32_t lanes, const T* items, std::uint32_t count, const Treat& treat) {
    const std::uint32_t all = (1u << lanes) - 1;
    std::uint64_t bits = 0;
    std::uint32_t done = 0;
    for (; done + lanes <= count; done += lanes)
        bits |= std::uint64_t{treat(items + done, all)} << done;
    if (done < count) {
        const auto rest = filled_up(items + done, items + count);
        bits |= std::uint64_t{treat(rest.data(), all >> (done + lanes - count))} << done;
    }
    return bits;
}

} // namespace talus::engine
