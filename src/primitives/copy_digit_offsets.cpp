// SPDX-License-Identifier: MIT
// CPU twin of copy_digit_offsets.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void copy_digit_offsets_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> offsets = state.words(launch.bound("Offsets"));
    const uint key_count = state.counters[launch.args[0]];
    const uint tile_count = divide_up(key_count, k_sort_tile);

    for (uint digit = 0; digit < k_digits; ++digit)
        offsets[digit] = key_count > 0 ? state.digit_counts[digit_count_index(digit, 0, tile_count)] : 0;
    offsets[k_digits] = key_count;
}

const Kernel copy_digit_offsets{"primitives/copy_digit_offsets", copy_digit_offsets_on_cpu};

} // namespace talus::engine
