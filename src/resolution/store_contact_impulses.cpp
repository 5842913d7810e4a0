// SPDX-License-Identifier: MIT
// CPU twin of store_contact_impulses.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void store_contact_impulses_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_manifold_count], [&](uint index) {
        const ContactConstraint& constraint = state.constraints[index];
        Manifold& manifold = state.manifolds[constraint.manifold];
        manifold.colour = state.manifold_keys[index] & ((1u << k_colour_bits) - 1);
        manifold.tangent_impulse_1 = constraint.tangent_impulse_1;
        manifold.tangent_impulse_2 = constraint.tangent_impulse_2;
        manifold.twist_impulse = constraint.twist_impulse;
        for (std::size_t i = 0; i < constraint.point_count; ++i)
            state.manifold_points[std::size_t{4} * constraint.manifold + i].normal_impulse =
                state.constraint_points[std::size_t{4} * index + i].normal_impulse;
    });
}

const Kernel store_contact_impulses{"resolution/store_contact_impulses", store_contact_impulses_on_cpu};

} // namespace talus::engine
