// SPDX-License-Identifier: MIT
// CPU twin of integrate_bodies.comp.glsl.
#include "resolution/lane_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void integrate_bodies_on_cpu(CpuState& state, const Launch& launch) {
    for_each_part(state, 0, state.parameters.body_count, [&](const uint* bodies, uint count) {
        uint wanted[k_most_lanes];
        uint wanted_count = 0;
        for (uint i = 0; i < count; ++i) {
            const BodyInertia& inertia = state.inertias[bodies[i]];
            const bool is_grouped = (inertia.traits & k_trait_grouped) != 0; // see solve_island_groups
            if (!is_grouped && inertia.substeps > 0) wanted[wanted_count++] = bodies[i];
        }
        pass_over_bodies(state, launch.args[0], wanted, wanted_count);
    });
}

const Kernel integrate_bodies{"resolution/integrate_bodies", integrate_bodies_on_cpu};

} // namespace talus::engine
