// SPDX-License-Identifier: MIT
// CPU twin of press_sleepers.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void press_sleepers_on_cpu(CpuState& state, const Launch&) {
    for (uint pair = 0; pair < state.counters[k_counter_graph_pairs]; ++pair) {
        const Manifold& manifold = state.manifolds[pair];
        const bool awake_a = state.islands[manifold.body_a] != k_none;
        const bool awake_b = state.islands[manifold.body_b] != k_none;
        if (awake_a == awake_b || !is_active(manifold)) continue;
        const uint other = awake_a ? manifold.body_b : manifold.body_a;
        if (state.substeps[other] == 0) state.island_fill[other] |= k_pressed;
    }
}

const Kernel press_sleepers{"resolution/press_sleepers", press_sleepers_on_cpu};

} // namespace talus::engine
