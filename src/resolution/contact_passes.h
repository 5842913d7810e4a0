// SPDX-License-Identifier: MIT
// The passes over one contact constraint, for the CPU. The GPU's counterpart is contact_passes.glsl.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

enum class ContactPass : uint {
    WarmStart,
    Solve, ///< with bias
    Relax, ///< without
    Restitution,
};

inline void pass_over_constraint(CpuState& state, ContactPass pass, uint index) {
    const ContactConstraint& c = state.constraints[index];
    if (pass == ContactPass::Restitution && c.restitution == 0.0f) return;
    const BodyInertia& inertia_a = state.inertias[c.body_a];
    const BodyInertia& inertia_b = state.inertias[c.body_b];
    const Approach approach = measure_approach(c.normal, state.deltas[c.body_a], state.deltas[c.body_b]);
    const Tangents t = contact_tangents(c.normal);
    const Softness soft = contact_softness(c.against_static == 1, state.parameters);
    PointState s;
    s.velocities = {state.velocities[c.body_a], state.velocities[c.body_b]};
    for (std::size_t i = 0; i < c.point_count; ++i) {
        ContactConstraintPoint& point = state.constraint_points[std::size_t{4} * index + i];
        if (pass == ContactPass::WarmStart) {
            s.velocities = apply_impulse(s.velocities, point_impulse(point, c.normal, t), point.anchor_a,
                                         point.anchor_b, inertia_a, inertia_b);
            continue;
        }
        s.point = point;
        if (pass == ContactPass::Restitution) {
            s = apply_point_restitution(s, c.normal, c.restitution, inertia_a, inertia_b, state.parameters);
        } else {
            const float separation = current_separation(point, approach);
            s = solve_point(s, c.normal, t, c.friction, separation, pass == ContactPass::Solve, soft, inertia_a,
                            inertia_b, state.parameters);
        }
        point = s.point;
    }
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (s.velocities.a.inverse_mass > 0.0f) state.velocities[c.body_a] = s.velocities.a;
    if (s.velocities.b.inverse_mass > 0.0f) state.velocities[c.body_b] = s.velocities.b;
}

/// One pass over all manifolds of a colour; those of the overflow set one after the other.
inline void pass_over_colour(CpuState& state, ContactPass pass, uint colour) {
    const uint first = state.colour_offsets[colour];
    const uint count = state.colour_offsets[colour + 1] - first;
    const uint grain = colour == k_overflow_colour ? UINT32_MAX : 64;
    state.parallel(
        count, [&](uint i) { pass_over_constraint(state, pass, first + i); }, grain);
}

} // namespace talus::engine
