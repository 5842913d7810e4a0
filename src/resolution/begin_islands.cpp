// SPDX-License-Identifier: MIT
// CPU twin of begin_islands.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void begin_islands_on_cpu(CpuState& state, const Launch&) {
    const Parameters& p = state.parameters;
    state.parallel(p.body_count, [&](uint body) {
        const BodyShape& shape = state.shapes[body];
        state.islands[body] = is_movable(shape) ? body : k_none;
        state.substeps[body] = p.least_substeps;
        state.island_sizes[body] = state.island_starts[body] = 0;
        const bool restless = is_restless(state.poses[body], state.velocities[body], shape, p);
        state.island_fill[body] = restless ? k_awake : 0;
        if (is_mover(shape) && !is_movable(shape)) // all write the same
            std::atomic_ref(state.counters[k_counter_launched_substeps]).store(p.least_substeps);
    });
}

const Kernel begin_islands{"resolution/begin_islands", begin_islands_on_cpu};

} // namespace talus::engine
