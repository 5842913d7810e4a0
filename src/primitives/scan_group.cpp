// SPDX-License-Identifier: MIT
// CPU twin of scan_group.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void scan_group_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> values = state.words(launch.bound("Values"));
    const auto [count_counter, total_counter, divisor, factor] = launch.args;
    const uint value_count = scan_count(state.counters[count_counter], divisor, factor);

    uint sum = 0;
    for (uint i = 0; i < value_count; ++i) {
        const uint value = values[i];
        values[i] = sum;
        sum += value;
    }
    if (total_counter != k_none) state.counters[total_counter] = sum;
}

const Kernel scan_group{"primitives/scan_group", scan_group_on_cpu, 1};

} // namespace talus::engine
