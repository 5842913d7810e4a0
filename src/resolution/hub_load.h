// SPDX-License-Identifier: MIT
// The load on a contact of a hub, for the CPU. The GPU's counterpart is hub_load.glsl.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// What its points carried in the last step (N s).
inline float load_on(const CpuState& state, uint pair) {
    float sum = 0.0f;
    for (uint i = 0; i < state.manifolds[pair].point_count; ++i)
        sum += state.manifold_points[std::size_t{4} * pair + i].normal_impulse;
    return sum;
}

inline uint part_of_load(const CpuState& state, uint pair, uint hub) {
    return part_of_load(load_on(state, pair), state.body_colours[body_word(hub, k_largest_load)],
                        state.body_colours[body_word(hub, k_new_edges)]);
}

} // namespace talus::engine
