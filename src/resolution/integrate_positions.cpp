// SPDX-License-Identifier: MIT
// CPU twin of integrate_positions.comp.glsl.
#include "resolution/body_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void integrate_positions_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.parameters.body_count, [&](uint body) { integrate_body_position(state, body); });
}

const Kernel integrate_positions{"resolution/integrate_positions", integrate_positions_on_cpu};

} // namespace talus::engine
