// SPDX-License-Identifier: MIT
// CPU twin of store_contact_impulses.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void store_contact_impulses_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_manifold_count], [&](uint index) {
        const ContactConstraint& constraint = state.constraints[index];
        state.manifolds[constraint.manifold].colour = state.manifold_keys[index] & ((1u << k_colour_bits) - 1);
        for (std::size_t i = 0; i < constraint.point_count; ++i) {
            const ContactConstraintPoint& point = state.constraint_points[std::size_t{4} * index + i];
            ManifoldPoint& target = state.manifold_points[std::size_t{4} * constraint.manifold + i];
            target.normal_impulse = point.normal_impulse;
            target.tangent_impulse_1 = point.tangent_impulse_1;
            target.tangent_impulse_2 = point.tangent_impulse_2;
        }
    });
}

const Kernel store_contact_impulses{"resolution/store_contact_impulses", store_contact_impulses_on_cpu};

} // namespace talus::engine
