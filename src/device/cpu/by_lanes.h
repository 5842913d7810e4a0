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

/// Calls `treat(done, some, active)` for all items, as many at a time as there are lanes: how many were treated before,
/// the items, and a bit for each lane that has one.
template <typename T, typename Treat>
void by_lanes(std::uint32_t lanes, const T* items, std::uint32_t count, const Treat& treat) {
    const std::uint32_t all = (1u << lanes) - 1;
    std::uint32_t done = 0;
    for (; done + lanes <= count; done += lanes)
        treat(done, items + done, all);
    if (done == count) return;
    const auto rest = filled_up(items + done, items + count);
    treat(done, rest.data(), all >> (done + lanes - count));
}

} // namespace talus::engine
