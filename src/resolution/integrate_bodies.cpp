// SPDX-License-Identifier: MIT
// CPU twin of integrate_bodies.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_contacts.h"

namespace talus::engine {

static std::vector<uint> bodies_to_integrate(const CpuState& state) {
    std::vector<uint> bodies;
    for (uint body = 0; body < state.parameters.body_count; ++body) {
        const BodyInertia& inertia = state.inertias[body];
        const bool is_grouped = (inertia.traits & k_trait_grouped) != 0; // see solve_island_groups
        if (!is_grouped && inertia.substeps > 0) bodies.push_back(body);
    }
    return bodies;
}

static void integrate_bodies_on_cpu(CpuState& state, const Launch& launch) {
    const uint tick = launch.args[0], grain = k_parallel_grain / 4 / lane_passes().lanes;
    state.some_bounce = launch.args[1] != 0;
    BodyBatches& bodies = solver_batches(state).bodies;
    if (tick == 0) {
        bodies.assign(bodies_to_integrate(state));
        state.parallel(
            bodies.count(), [&](uint batch) { bodies.take(state, batch); }, grain);
    }
    state.parallel(
        bodies.count(), [&](uint batch) { bodies.integrate(state, tick, batch); }, grain);
}

const Kernel integrate_bodies{"resolution/integrate_bodies", integrate_bodies_on_cpu};

} // namespace talus::engine
