// SPDX-License-Identifier: MIT
// The load on a contact of a hub, for the CPU. The GPU's counterpart is hub_load.glsl.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// The hub that a manifold is an edge of; k_none where there is none, or both bodies are hubs.
inline uint hub_of(const CpuState& state, const Manifold& manifold) {
    const auto is_found_hub = [&](uint body) { return state.body_colours[body_word(body, k_hub_word)] != 0; };
    const bool of_a = is_found_hub(manifold.body_a);
    if (of_a == is_found_hub(manifold.body_b)) return k_none;
    return of_a ? manifold.body_a : manifold.body_b;
}

/// What its points carried in the last step (N s).
inline float load_on(const CpuState& state, uint pair) {
    float sum = 0.0f;
    for (int i = 0; i < static_cast<int>(state.manifolds[pair].point_count); ++i)
        sum += state.point_impulses[pair].normal[i];
    return sum;
}

/// `load`: load_on() of the pair.
inline uint part_of_load(const CpuState& state, uint pair, float load, uint hub) {
    const Manifold& manifold = state.manifolds[pair];
    const float largest = uintBitsToFloat(largest_load(state.body_colours[body_word(hub, k_largest_load)]));
    const uint edge_count = count_new(state.body_colours[body_word(hub, k_new_edges)]);
    if (largest == 0.0f) return part_by_gravity(manifold.normal, manifold.body_a == hub, edge_count, state.parameters);
    return part_of_load(load, largest, edge_count);
}

inline uint colours_of_hubs_edge(const CpuState& state, const Manifold& manifold, uint part, uint hub,
                                 bool both_movable) {
    const auto word = [&](uint index) { return state.body_colours[body_word(hub, index)]; };
    return colours_below_hubs(carries_hub(part, word(k_whole_load), manifold.colour), both_movable, manifold.colour,
                              largest_load(word(k_largest_load)), state.parameters);
}

} // namespace talus::engine
