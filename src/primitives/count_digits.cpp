// SPDX-License-Identifier: MIT
// CPU twin of count_digits.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void count_digits_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> keys = state.words(launch.bound("Keys"));
    const uint key_count = state.counters[launch.args[0]];
    const uint shift = launch.args[1];
    const uint tile_count = divide_up(key_count, k_sort_tile);

    const auto count_tile = [&](uint tile) {
        std::array<uint, k_digits> counts{};
        for (uint i = tile * k_sort_tile; i < min((tile + 1) * k_sort_tile, key_count); ++i)
            ++counts[digit_of(keys[i], shift)];
        for (uint digit = 0; digit < k_digits; ++digit)
            state.digit_counts[digit_count_index(digit, tile, tile_count)] = counts[digit];
    };
    state.parallel(tile_count, count_tile, k_parallel_tiles);
}

const Kernel count_digits{"primitives/count_digits", count_digits_on_cpu, k_sort_tile};

} // namespace talus::engine
