// SPDX-License-Identifier: MIT
// CPU twin of shorten_paths.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/island_roots.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void shorten_paths_on_cpu(CpuState& state, const Launch&) {
    const Array<uint>& islands = state.islands;
    for (uint body = 0; body < state.counters[k_counter_graph_bodies]; ++body) {
        if (islands[body] != k_none) islands[body] = root_of(islands, body);
    }
}

const Kernel shorten_paths{"resolution/shorten_paths", shorten_paths_on_cpu};

} // namespace talus::engine
