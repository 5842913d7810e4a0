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

/// `load`: load_on() of the pair.
inline uint part_of_load(const CpuState& state, uint pair, float load, uint hub) {
    const Manifold& manifold = state.manifolds[pair];
    const float largest = uintBitsToFloat(largest_load(state.body_colours[body_word(hub, k_largest_load)]));
    const uint edge_count = state.body_colours[body_word(hub, k_new_edges)];
    if (largest == 0.0f) return part_by_gravity(manifold.normal, manifold.body_a == hub, edge_count, state.parameters);
    return part_of_load(load, largest, edge_count);
}

} // namespace talus::engine
