// SPDX-License-Identifier: MIT
// CPU twin of integrate_velocities.comp.glsl.
#include "resolution/body_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void integrate_velocities_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.parameters.body_count, [&](uint body) { integrate_body_velocity(state, body); });
}

const Kernel integrate_velocities{"resolution/integrate_velocities", integrate_velocities_on_cpu};

} // namespace talus::engine
