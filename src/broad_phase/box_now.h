// SPDX-License-Identifier: MIT
// A body's world bounding box as the body is now, without a skin.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

inline Aabb box_now(const CpuState& state, uint body) {
    return compute_aabb(state.poses[body], state.velocities[body], state.shapes[body], state.parameters);
}

} // namespace talus::engine
