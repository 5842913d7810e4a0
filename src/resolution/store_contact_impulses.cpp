// SPDX-License-Identifier: MIT
// CPU twin of store_contact_impulses.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void store_contact_impulses_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_manifold_count], [&](uint index) {
        const ContactConstraint& c = state.constraints[index];
        Manifold& manifold = state.manifolds[c.manifold];
        vec4 impulse(0.0f);
        for (uint i = 0; i < c.point_count; ++i) {
            const std::size_t point = std::size_t{4} * index + i;
            impulse[static_cast<int>(i)] =
                state.constraint_points[point].normal_impulse * static_cast<float>(c.substeps);
            state.manifold_points[std::size_t{4} * c.manifold + i].normal_impulse = impulse[static_cast<int>(i)];
        }
        manifold.colour = state.manifold_keys[index] & ((1u << k_colour_bits) - 1);
        manifold = finish_manifold(manifold, c, impulse, state.properties[c.body_a].inverse_mass,
                                   state.properties[c.body_b].inverse_mass, state.parameters);
    });
}

const Kernel store_contact_impulses{"resolution/store_contact_impulses", store_contact_impulses_on_cpu};

} // namespace talus::engine
