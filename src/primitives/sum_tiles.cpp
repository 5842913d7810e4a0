// SPDX-License-Identifier: MIT
// CPU twin of sum_tiles.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void sum_tiles_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> values = state.words(launch.bound("Values"));
    const auto [count_counter, unused, divisor, factor] = launch.args;
    const uint value_count = scan_count(state.counters[count_counter], divisor, factor);

    for (uint first = 0; first < value_count; first += k_scan_tile) {
        uint sum = 0;
        for (uint i = first; i < min(first + k_scan_tile, value_count); ++i)
            sum += values[i];
        state.scan_sums[first / k_scan_tile] = sum;
    }
}

const Kernel sum_tiles{"primitives/sum_tiles", sum_tiles_on_cpu, k_scan_tile};

} // namespace talus::engine
