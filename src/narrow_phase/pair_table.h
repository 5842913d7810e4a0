// SPDX-License-Identifier: MIT
// The search in the pair table, for twins; find_old_manifold.glsl is that of the kernels.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// The last step's manifold of a pair, or k_none.
inline uint find_old_manifold(const CpuState& state, uint body_a, uint body_b) {
    const uint mask = state.parameters.table_size - 1;
    for (uint slot = hash_pair(body_a, body_b) & mask;; slot = (slot + 1) & mask) {
        const uint old = state.pair_table[slot];
        if (old == k_none) return k_none;
        const Manifold& manifold = state.old_manifolds[old];
        if (manifold.body_a == body_a && manifold.body_b == body_b) return old;
    }
}

} // namespace talus::engine
