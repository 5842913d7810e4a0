// SPDX-License-Identifier: MIT
// CPU twin of integrate_bodies.comp.glsl.
#include "resolution/body_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void integrate_bodies_on_cpu(CpuState& state, const Launch& launch) {
    state.parallel(state.parameters.body_count, [&](uint body) {
        const bool is_grouped = (state.inertias[body].traits & k_trait_grouped) != 0; // see solve_island_groups
        if (!is_grouped) integrate_body(state, body, launch.args[0]);
    });
}

const Kernel integrate_bodies{"resolution/integrate_bodies", integrate_bodies_on_cpu};

} // namespace talus::engine
