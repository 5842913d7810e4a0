// SPDX-License-Identifier: MIT
// Some of all pairs, on the CPU: a bit for each, in two words for each part.
#pragma once

#include "device/cpu/cpu_state.h"

namespace talus::engine {

/// That a thread treats together.
inline constexpr uint k_pairs_a_part = 64;

/// `first`: the part's first pair.
inline void put_bits(const Array<uint>& words, uint first, std::uint64_t bits) {
    words[first / 32] = static_cast<uint>(bits);
    if (first / 32 + 1 < words.size) words[first / 32 + 1] = static_cast<uint>(bits >> 32);
}
inline std::uint64_t bits_at(const Array<uint>& words, uint first) {
    const uint high = first / 32 + 1 < words.size ? words[first / 32 + 1] : 0;
    return std::uint64_t{high} << 32 | words[first / 32];
}

} // namespace talus::engine
