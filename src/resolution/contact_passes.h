// SPDX-License-Identifier: MIT
// The passes over one contact constraint, for the CPU. The GPU's counterpart is contact_passes.glsl.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

enum class ContactPass : uint {
    WarmStart,
    Solve,      ///< with bias
    SolveAgain, ///< further iterations in the same sub-step
    Relax,      ///< without bias
};

inline vec4 separations(const CpuState& state, const ContactConstraint& c, const ContactConstraintPoint* points) {
    const Approach approach = measure_approach(c.normal, c.traits, state.deltas[c.body_a], state.deltas[c.body_b]);
    return {current_separation(points[0], approach), current_separation(points[1], approach),
            current_separation(points[2], approach), current_separation(points[3], approach)};
}

inline PassTarget target_of_pass(const CpuState& state, ContactPass pass, const ContactConstraint& c,
                                 const ContactConstraintPoint* points, const ManifoldRows& rows,
                                 const ManifoldImpulses& impulses) {
    const Parameters& p = state.parameters;
    PassTarget target{};
    target.friction = make_friction_target(rows, impulses.normal);
    target.old_share = pass == ContactPass::Solve ? 0.0f : 1.0f;
    target.moved_since = pass == ContactPass::Relax;
    target.slip = measure_slip(c.gap, c.traits, state.deltas[c.body_a], state.deltas[c.body_b]);
    const Substep substep = make_substep(c.substeps, is_against_static(c.traits), p);
    const bool moves = pass != ContactPass::Relax && is_against_static(c.traits);
    target.half_h = moves ? 0.5f * substep_length(c.substeps, p) : 0.0f;
    target.normal = make_normal_target(separations(state, c, points), rows, impulses.normal, pass != ContactPass::Relax,
                                       substep, p);
    if (pass == ContactPass::Relax)
        for (int i = 0; i < 4; ++i)
            target.normal.lower[i] =
                least_relaxed(points[i], c.normal, impulses.normal[i], impulses.total[i], substep.soft);
    return target;
}

/// Instead of the pass that has found the hit, whose result was not put back.
inline ManifoldState pass_over_hit(CpuState& state, const ManifoldState& before, const ContactConstraint& c,
                                   ContactConstraintPoint* points, const ManifoldRows& rows, const PassTarget& target) {
    const Substep substep = make_substep(c.substeps, is_against_static(c.traits), state.parameters);
    const vec4 closing = closing_speeds(separations(state, c, points), substep.inv_h);
    const Hit hit = solve_hit(before.velocities, rows, target.slip, closing, substep.inv_h, state.parameters);
    const auto take = [&](uint body, const BodyVelocity& was, const BodyVelocity& is) {
        BodyWarmStart& warm = state.warm_starts[body];
        if (was.inverse_mass > 0.0f) warm = take_hit(warm, was, is, hit.time);
    };
    take(c.body_a, before.velocities.a, hit.velocities.a);
    take(c.body_b, before.velocities.b, hit.velocities.b);
    for (int i = 0; i < 4; ++i)
        points[i].hit_impulse += hit.impulse[i];
    return end_hit(before, hit, target.old_share);
}

inline void pass_over_constraint(CpuState& state, ContactPass pass, uint substep, uint index) {
    ContactConstraint& c = state.constraints[index];
    ContactConstraintPoint* const points = &state.constraint_points[std::size_t{4} * index];
    if (substep >= c.substeps) return;
    const ManifoldRows rows =
        make_rows(c, points[0], points[1], points[2], points[3], state.inertias[c.body_a], state.inertias[c.body_b]);
    const ManifoldState before{{state.velocities[c.body_a], state.velocities[c.body_b]},
                               make_impulses(c, points[0], points[1], points[2], points[3]),
                               false};
    ManifoldState s = before;
    if (pass == ContactPass::WarmStart) {
        s.velocities = warm_start_manifold(s.velocities, rows, s.impulses);
    } else {
        const PassTarget target = target_of_pass(state, pass, c, points, rows, s.impulses);
        s = solve_manifold(s, rows, target);
        if (s.is_hit && pass == ContactPass::Relax) return; // the next step's
        if (s.is_hit) s = pass_over_hit(state, before, c, points, rows, target);
        c.tangent_impulse_1 = s.impulses.friction.x;
        c.tangent_impulse_2 = s.impulses.friction.y;
        c.twist_impulse = s.impulses.friction.z;
        c.moment = s.impulses.moment;
        for (int i = 0; i < 4; ++i) {
            points[i].normal_impulse = s.impulses.normal[i];
            points[i].total_impulse = s.impulses.total[i];
        }
    }
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (s.velocities.a.inverse_mass > 0.0f) state.velocities[c.body_a] = s.velocities.a;
    if (s.velocities.b.inverse_mass > 0.0f) state.velocities[c.body_b] = s.velocities.b;
}

} // namespace talus::engine
