// SPDX-License-Identifier: MIT
// CPU twin of store_contact_impulses.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "resolution/stored_hits.h"
#include "state/formulas.h"

namespace talus::engine {

static void store_contact_impulses_on_cpu(CpuState& state, const Launch& launch) {
    const uint manifold_count = state.counters[k_counter_manifold_count];
    state.parallel(state.counters[k_counter_ordered_pairs], [&](uint entry) {
        const uint index = state.manifold_places[entry];
        if (index >= manifold_count) return; // they do not touch, or sleep
        const uint pair = launch.args[0] == 1 ? state.listed_pairs[entry] : entry;
        ContactConstraint& c = state.constraints[index];
        Manifold& manifold = state.manifolds[pair];
        vec4 impulse(0.0f);
        for (int i = 0; i < static_cast<int>(point_count_of(c.counts)); ++i)
            impulse[i] = impulse_of_step(c.normal_impulse[i], c.total_impulse[i], substeps_of_contact(c.counts));
        state.point_impulses[pair] = {impulse};
        if (launch.args[1] == 1) c.total_impulse = with_hits(c.total_impulse, hits_of_contact(state, index));
        manifold.colour = colour_of_step(state.manifold_keys[index], c.traits);
        const uint demand = manifold.demand;
        const Standing standing = find_standing(c.normal, c.centre_a, c.centre_b, c.gap, state.parameters);
        const uint* const above = &state.told_loads[k_told_words * body_above(standing, c.body_a, c.body_b)];
        const uint below = body_below(standing, c.body_a, c.body_b);
        manifold =
            finish_manifold(manifold, c, standing, impulse, above[k_told_mass], above[k_told_height],
                            state.told_loads[k_told_words * below + k_told_mass],
                            state.told_loads[told_foot_word(below, state.parameters.body_count)], state.parameters);
        // Of the next step.
        if (!asks_alike(manifold.demand, demand, substeps_of_contact(c.counts), launch.args[2] == 1))
            std::atomic_ref(state.counters[k_counter_graph_due]).store(1, std::memory_order_relaxed);
    });
}

const Kernel store_contact_impulses{"resolution/store_contact_impulses", store_contact_impulses_on_cpu};

} // namespace talus::engine
