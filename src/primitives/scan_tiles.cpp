// SPDX-License-Identifier: MIT
// CPU twin of scan_tiles.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void scan_tiles_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> values = state.words(launch.bound("Values"));
    const auto [count_counter, total_counter, divisor, factor] = launch.args;
    const uint value_count = scan_count(state.counters[count_counter], divisor, factor);

    uint before = 0; // the tile
    for (uint first = 0; first < value_count; first += k_scan_tile) {
        uint sum = before;
        before += state.scan_sums[first / k_scan_tile];
        for (uint i = first; i < min(first + k_scan_tile, value_count); ++i) {
            const uint value = values[i];
            values[i] = sum;
            sum += value;
        }
    }
    if (total_counter != k_none) state.counters[total_counter] = before;
}

const Kernel scan_tiles{"primitives/scan_tiles", scan_tiles_on_cpu, k_scan_tile};

} // namespace talus::engine
