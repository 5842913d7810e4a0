// SPDX-License-Identifier: MIT
// CPU twin of fill_pair_table.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/narrow_phase.h"
#include "state/formulas.h"

namespace talus::engine {

static void fill_pair_table_on_cpu(CpuState& state, const Launch&) {
    const uint mask = state.parameters.table_size - 1;
    state.parallel(state.counters[k_counter_old_pair_count], [&](uint pair) {
        const Manifold& manifold = state.old_manifolds[pair];
        if (manifold.point_count == 0) return;
        uint slot = hash_pair(manifold.body_a, manifold.body_b) & mask;
        for (uint expected = k_none; !std::atomic_ref(state.pair_table[slot]).compare_exchange_strong(expected, pair);
             expected = k_none)
            slot = (slot + 1) & mask;
    });
}

const Kernel fill_pair_table{"narrow_phase/fill_pair_table", fill_pair_table_on_cpu};

} // namespace talus::engine
