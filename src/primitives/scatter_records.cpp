// SPDX-License-Identifier: MIT
// CPU twin of scatter_records.comp.glsl.
#include <cstring>

#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void scatter_records_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_did_not_fit] != 0) return;
    const uint record_count = launch.args[0];
    const std::size_t words = std::size_t{4} * launch.args[1];
    const uint* records = state.changes.data + record_count;
    uint* target = state.words(launch.bound("Target")).data;
    for (uint i = 0; i < record_count; ++i)
        std::memcpy(target + words * state.changes[i], records + words * i, words * sizeof(uint));
}

const Kernel scatter_records{"primitives/scatter_records", scatter_records_on_cpu};

} // namespace talus::engine
