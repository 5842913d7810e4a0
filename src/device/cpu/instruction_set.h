// SPDX-License-Identifier: MIT
// Which of the files that are compiled for a set of instructions this machine can run.
#pragma once

#include <cstdint>

namespace talus::engine {

/// Items side by side in the widest registers.
inline constexpr std::uint32_t k_most_lanes = 8;

#ifdef TALUS_HAS_AVX2
inline bool has_avx2() {
    static const bool has_it = __builtin_cpu_supports("avx2") != 0;
    return has_it;
}

/// Of what is compiled for each set of instructions, that with the widest registers that this machine has.
#define TALUS_FOR_THIS_MACHINE(name) (has_avx2() ? name##_avx2 : name##_base)
#else
#define TALUS_FOR_THIS_MACHINE(name) name##_base
#endif

} // namespace talus::engine
