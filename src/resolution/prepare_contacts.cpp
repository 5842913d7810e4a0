// SPDX-License-Identifier: MIT
// CPU twin of prepare_contacts.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "resolution/hub_load.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static float share_of_contact(const CpuState& state, uint pair, uint colour) {
    if (!is_hub_colour(colour)) return 1.0f;
    const Manifold& manifold = state.manifolds[pair];
    const bool of_a = (state.inertias[manifold.body_a].traits & k_trait_hub) != 0;
    const uint hub = of_a ? manifold.body_a : manifold.body_b;
    const auto word = [&](uint index) { return state.body_colours[body_word(hub, index)]; };
    return share_of_hub(part_of_load(state, pair, load_on(state, pair), hub),
                        word(k_whole_load) - word(k_unshared_load), shares_of_hub(word(k_new_edges), word(k_hub_word)));
}

static void tell_load(CpuState& state, const LoadBelow& load, uint height) {
    if (load.mass == 0) return;
    uint* const told = &state.told_loads[k_told_words * load.body];
    std::atomic_ref(told[k_told_mass]).fetch_add(load.mass, std::memory_order_relaxed);
    const std::atomic_ref highest(told[k_told_height]);
    for (uint before = highest.load(); before < height && !highest.compare_exchange_weak(before, height);) {
    }
}

static void prepare_contacts_on_cpu(CpuState& state, const Launch& launch) {
    state.parallel(state.counters[k_counter_manifold_count], [&](uint index) {
        const uint manifold_index = state.manifold_order[index];
        if (!is_among(manifold_index, launch.args[0], launch.args[1])) return;
        const Manifold& manifold = state.manifolds[manifold_index];
        const BodyInertia& inertia_a = state.inertias[manifold.body_a];
        const BodyInertia& inertia_b = state.inertias[manifold.body_b];
        const float inverse_mass_a = state.velocities[manifold.body_a].inverse_mass;
        const float inverse_mass_b = state.velocities[manifold.body_b].inverse_mass;
        tell_load(state, load_below(manifold, inverse_mass_a, inverse_mass_b, state.parameters),
                  height_of(manifold.history));
        const uint colour = colour_of_key(state.manifold_keys[index]);
        const ManifoldPoint* const points = &state.manifold_points[std::size_t{4} * manifold_index];
        ContactConstraint& c = state.constraints[index];
        c = begin_constraint(manifold, manifold_index, colour, share_of_contact(state, manifold_index, colour),
                             inverse_mass_a, inverse_mass_b, inertia_a, inertia_b);
        for (uint i = 0; i < manifold.point_count; ++i)
            c = add_to_centre(c, points[i]);
        c = end_centre(c, state.poses[manifold.body_a].position, state.poses[manifold.body_b].position);
        const Meeting meeting = make_meeting(c, inertia_a, inertia_b);
        c.friction_mass = friction_masses(meeting);
        const NormalResponse response = respond_to_normals(meeting);
        for (uint i = 0; i < manifold.point_count; ++i)
            c = add_point(c, static_cast<int>(i), points[i], meeting, response);
    });
}

const Kernel prepare_contacts{"resolution/prepare_contacts", prepare_contacts_on_cpu};

} // namespace talus::engine
