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
    ContactConstraint& c = state.constraints[index];
    ContactConstraintPoint* const points = &state.constraint_points[std::size_t{4} * index];
    if (pass == ContactPass::Restitution && c.restitution == 0.0f) return;
    const vec3 n = c.normal;
    const BodyInertia& inertia_a = state.inertias[c.body_a];
    const BodyInertia& inertia_b = state.inertias[c.body_b];
    const Tangents t = contact_tangents(n);
    const Softness soft = contact_softness(c.against_static == 1, state.parameters);
    ManifoldState s{{state.velocities[c.body_a], state.velocities[c.body_b]}, c};
    if (pass == ContactPass::Solve || pass == ContactPass::Relax) {
        Pressure pressure = no_pressure();
        for (uint i = 0; i < c.point_count; ++i)
            pressure = add_pressure(pressure, points[i]);
        s = solve_friction(s, t, pressure, inertia_a, inertia_b);
        c = s.c;
    } else if (pass == ContactPass::WarmStart) {
        s = start_friction(s, t, inertia_a, inertia_b);
    }
    const Approach approach = measure_approach(n, state.deltas[c.body_a], state.deltas[c.body_b]);
    PointState p;
    p.velocities = s.velocities;
    for (uint i = 0; i < c.point_count; ++i) {
        p.point = points[i];
        if (pass == ContactPass::WarmStart) {
            p = start_point(p, n, inertia_a, inertia_b);
            continue;
        }
        if (pass == ContactPass::Restitution) {
            p = apply_point_restitution(p, n, c.restitution, inertia_a, inertia_b, state.parameters);
        } else {
            const float separation = current_separation(p.point, approach);
            p = solve_point(p, n, separation, pass == ContactPass::Solve, soft, inertia_a, inertia_b, state.parameters);
        }
        points[i] = p.point;
    }
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (p.velocities.a.inverse_mass > 0.0f) state.velocities[c.body_a] = p.velocities.a;
    if (p.velocities.b.inverse_mass > 0.0f) state.velocities[c.body_b] = p.velocities.b;
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
