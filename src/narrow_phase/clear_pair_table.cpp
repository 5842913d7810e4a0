// SPDX-License-Identifier: MIT
// CPU twin of clear_pair_table.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/narrow_phase.h"

namespace talus::engine {

static void clear_pair_table_on_cpu(CpuState& state, const Launch&) {
    std::fill_n(state.pair_table.data, state.dispatches[k_dispatch_table].items, k_none);
}

const Kernel clear_pair_table{"narrow_phase/clear_pair_table", clear_pair_table_on_cpu};

} // namespace talus::engine
