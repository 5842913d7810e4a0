// SPDX-License-Identifier: MIT
// What the caller does to a body in the step, for the CPU. The GPU's counterpart is body_load.glsl.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// There may be no room for loads where no body has one.
inline BodyLoad load_of_body(const CpuState& state, uint body) {
    return (state.inertias[body].traits & k_trait_loaded) != 0 ? state.loads[body] : no_load();
}

} // namespace talus::engine
