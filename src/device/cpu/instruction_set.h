// SPDX-License-Identifier: MIT
// The sets of instructions that some files are compiled for (src/CMakeLists.txt), and which of them this machine can
// run.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace talus::engine {

/// Items side by side in the widest registers.
inline constexpr std::uint32_t k_most_lanes = 8;

// What such a file defines has the set that it is compiled for at the end of its name.
#define TALUS_OF_SET(name) TALUS_JOINED(name, TALUS_SET)
#define TALUS_JOINED(name, set) TALUS_JOINED_NAMES(name, set)
#define TALUS_JOINED_NAMES(name, set) name##_##set

#ifdef TALUS_HAS_AVX
#define TALUS_DECLARE_OF_SETS(type, name) extern const type name##_base, name##_avx2, name##_avx512
/// Pointers to what there is of each set, those that need the most behind the others.
#define TALUS_OF_SETS(name)                                                                                            \
    std::array {                                                                                                       \
        &name##_base, &name##_avx2, &name##_avx512                                                                     \
    }

/// How many of the sets this machine can run.
inline std::size_t runnable_sets() {
    static const std::size_t count = [] {
        if (!__builtin_cpu_supports("avx2")) return std::size_t{1};
        const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                                __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
        return std::size_t{has_avx512 ? 3u : 2u};
    }();
    return count;
}
#else
#define TALUS_DECLARE_OF_SETS(type, name) extern const type name##_base
#define TALUS_OF_SETS(name)                                                                                            \
    std::array {                                                                                                       \
        &name##_base                                                                                                   \
    }
inline std::size_t runnable_sets() {
    return 1;
}
#endif

/// No more of them are used than these. For tests, which compare them.
inline std::size_t usable_sets = std::numeric_limits<std::size_t>::max();

/// The quickest that this machine can run. The table is made once: some ask for every eight contacts.
#define TALUS_FOR_THIS_MACHINE(name)                                                                                   \
    ([]() -> const auto& {                                                                                             \
        static constexpr auto of_sets = TALUS_OF_SETS(name);                                                           \
        return *of_sets[std::min(runnable_sets(), usable_sets) - 1];                                                   \
    }())

} // namespace talus::engine
