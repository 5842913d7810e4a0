// SPDX-License-Identifier: MIT
// CPU twin of choose_sleepers.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void choose_sleepers_on_cpu(CpuState& state, const Launch& launch) {
    const Parameters& p = state.parameters;
    state.parallel(state.counters[k_counter_graph_bodies], [&](uint body) {
        const uint island = state.islands[body];
        if (island == k_none) return;
        bool asleep = (state.island_fill[island] & k_awake) == 0;
        if (sleeps_in_parts(state.island_sizes[island]))
            asleep = (state.island_fill[body] & (k_restless | k_touched)) == 0 && is_calm(state.rests[body], p);
        const bool multirate = is_multirate_island(state.island_sizes[island], launch.args[0]);
        const uint substeps = multirate ? k_multirate | state.substeps[body] : state.substeps[island];
        state.island_groups[body] = asleep ? 0 : substeps;
    });
}

const Kernel choose_sleepers{"resolution/choose_sleepers", choose_sleepers_on_cpu};

} // namespace talus::engine
