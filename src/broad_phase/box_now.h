// SPDX-License-Identifier: MIT
// A body's box as the body is now, without a skin.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

inline OrientedBox box_now(const CpuState& state, uint body) {
    return make_oriented_box(state.poses[body], state.velocities[body], state.shapes[body], state.parameters);
}

} // namespace talus::engine
