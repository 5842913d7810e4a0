// SPDX-License-Identifier: MIT
// The last step's contact of a pair, and what becomes of the counters, for twins; old_contact.glsl is that of the
// kernels.
#pragma once

#include <atomic>

#include "narrow_phase/pair_table.h"

namespace talus::engine {

/// Pairs that have been added come behind those of the last step.
inline bool was_listed(const CpuState& state, uint pair_index) {
    return pair_index < state.counters[k_counter_old_pair_count];
}

inline uint old_manifold_of(const CpuState& state, uint pair_index) {
    const Pair& pair = state.pairs[pair_index];
    if (state.counters[k_counter_pairs_changed] != 0) return find_old_manifold(state, pair.body_a, pair.body_b);
    return was_listed(state, pair_index) && state.old_manifolds[pair_index].point_count > 0 ? pair_index : k_none;
}

inline void compare_with_last(CpuState& state, uint pair_index) {
    if (state.counters[k_counter_pairs_changed] != 0) return;
    const Manifold &old = state.old_manifolds[pair_index], &manifold = state.manifolds[pair_index];
    if ((was_listed(state, pair_index) && is_active(old)) != is_active(manifold))
        std::atomic_ref(state.counters[k_counter_graph_due]).store(1, std::memory_order_relaxed);
    else if (is_active(manifold) && manifold.point_count != old.point_count)
        std::atomic_ref(state.counters[k_counter_contact_count])
            .fetch_add(manifold.point_count - old.point_count, std::memory_order_relaxed);
}

inline void put_none(CpuState& state, uint pair_index, float gap) {
    state.manifolds[pair_index] = no_manifold(state.pairs[pair_index], gap);
    state.point_impulses[pair_index] = {vec4(0.0f)};
}

} // namespace talus::engine
