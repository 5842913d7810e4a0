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

inline PassTarget target_of_pass(const CpuState& state, ContactPass pass, const ContactConstraint& c,
                                 const ContactConstraintPoint* points, const ManifoldRows& rows,
                                 const ManifoldImpulses& impulses) {
    const Parameters& p = state.parameters;
    PassTarget target{};
    target.friction = make_friction_target(rows, impulses.normal);
    if (pass == ContactPass::Restitution) {
        const vec4 approach_speed(points[0].approach_speed, points[1].approach_speed, points[2].approach_speed,
                                  points[3].approach_speed);
        target.normal = make_bounce_target(approach_speed, rows, impulses, c.restitution, p);
        return target;
    }
    const Approach approach = measure_approach(c.normal, state.deltas[c.body_a], state.deltas[c.body_b]);
    const vec4 separation(current_separation(points[0], approach), current_separation(points[1], approach),
                          current_separation(points[2], approach), current_separation(points[3], approach));
    const Substep substep = make_substep(c.substeps, c.against_static == 1, p);
    target.normal = make_normal_target(separation, rows, impulses.normal, pass == ContactPass::Solve, substep.soft,
                                       substep.inv_h, p);
    return target;
}

inline void pass_over_constraint(CpuState& state, ContactPass pass, uint substep, uint index) {
    ContactConstraint& c = state.constraints[index];
    ContactConstraintPoint* const points = &state.constraint_points[std::size_t{4} * index];
    if (substep >= c.substeps || (pass == ContactPass::Restitution && c.restitution == 0.0f)) return;
    const ManifoldRows rows = make_rows(c, points[0], points[1], points[2], points[3], state.inertias[c.body_a],
                                        state.inertias[c.body_b]);
    ManifoldState s{{state.velocities[c.body_a], state.velocities[c.body_b]},
                    make_impulses(c, points[0], points[1], points[2], points[3])};
    if (pass == ContactPass::WarmStart) {
        s.velocities = warm_start_manifold(s.velocities, rows, s.impulses);
    } else {
        const PassTarget target = target_of_pass(state, pass, c, points, rows, s.impulses);
        s = pass == ContactPass::Restitution ? solve_normals(s, rows, target.normal) : solve_manifold(s, rows, target);
        c.tangent_impulse_1 = s.impulses.friction.x;
        c.tangent_impulse_2 = s.impulses.friction.y;
        c.twist_impulse = s.impulses.friction.z;
        for (int i = 0; i < 4; ++i) {
            points[i].normal_impulse = s.impulses.normal[i];
            points[i].max_normal_impulse = s.impulses.most[i];
        }
    }
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (s.velocities.a.inverse_mass > 0.0f) state.velocities[c.body_a] = s.velocities.a;
    if (s.velocities.b.inverse_mass > 0.0f) state.velocities[c.body_b] = s.velocities.b;
}

} // namespace talus::engine
