// SPDX-License-Identifier: MIT
// A body's box as the body is now.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

inline OrientedBox box_now(const CpuState& state, uint body) {
    return make_oriented_box(state.poses[body], state.velocities[body], state.shapes[body], state.parameters);
}

/// As a search has it.
inline OrientedBox box_with_skin(const CpuState& state, uint body) {
    return with_skin(box_now(state, body), state.parameters);
}

} // namespace talus::engine
