// SPDX-License-Identifier: MIT
// CPU twin of scatter_keys.comp.glsl.
#include <numeric>

#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void scatter_keys_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> keys = state.words(launch.bound("Keys"));
    const Array<uint> values = state.words(launch.bound("Values"));
    const Array<uint> sorted_keys = state.words(launch.bound("SortedKeys"));
    const Array<uint> sorted_values = state.words(launch.bound("SortedValues"));
    const uint key_count = state.counters[launch.args[0]];
    const uint shift = launch.args[1];
    const uint tile_count = divide_up(key_count, k_sort_tile);

    uint* const counts = state.digit_counts.data;
    if (launch.args[2] == 1) std::exclusive_scan(counts, counts + tile_count * k_digits, counts, 0u);

    const bool are_numbers = (launch.args[3] & k_values_are_numbers) != 0;
    const bool gives_places = (launch.args[3] & k_gives_places) != 0;
    const auto scatter_tile = [&](uint tile) {
        std::array<uint, k_digits> places;
        for (uint digit = 0; digit < k_digits; ++digit)
            places[digit] = state.digit_counts[digit_count_index(digit, tile, tile_count)];
        for (uint i = tile * k_sort_tile; i < min((tile + 1) * k_sort_tile, key_count); ++i) {
            const uint place = places[digit_of(keys[i], shift)]++;
            sorted_keys[place] = keys[i];
            const uint value = are_numbers ? i : values[i];
            sorted_values[gives_places ? value : place] = gives_places ? place : value;
        }
    };
    state.parallel(tile_count, scatter_tile, k_parallel_tiles);
}

const Kernel scatter_keys{"primitives/scatter_keys", scatter_keys_on_cpu, k_sort_tile};

} // namespace talus::engine
