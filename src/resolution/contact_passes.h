// SPDX-License-Identifier: MIT
// The passes over one contact constraint, for the CPU. The GPU's counterpart is contact_passes.glsl.
#pragma once

#include "resolution/body_load.h"
#include "resolution/stored_hits.h"
#include "state/formulas.h"

namespace talus::engine {

enum class ContactPass : uint {
    WarmStart,
    Solve,      ///< with bias
    SolveAgain, ///< further iterations in the same sub-step
    Relax,      ///< without bias
};

/// The ticks of a step and their passes, in order: calls integrate(tick) and over_contacts(pass, tick). `last`: how
/// many ticks there are. The kernels' counterpart is solve_substeps.glsl.
template <typename Integrate, typename OverContacts> void
for_each_pass(uint last, uint iterations, bool relax, const Integrate& integrate, const OverContacts& over_contacts) {
    for (uint tick = 0; tick < last; ++tick) {
        integrate(tick);
        // Later sub-steps find their warm start body by body (body.shared.glsl).
        if (tick == 0) over_contacts(ContactPass::WarmStart, 0);
        for (uint i = 0; i < iterations; ++i)
            over_contacts(i == 0 ? ContactPass::Solve : ContactPass::SolveAgain, tick);
    }
    integrate(last); // the movement of the last one
    if (relax) over_contacts(ContactPass::Relax, 0);
}

inline Slip slip_of_pass(const CpuState& state, const ContactConstraint& c, const ManifoldRows& rows) {
    return measure_slip(rows.meeting, c.gap, c.traits, state.deltas[c.body_a], state.deltas[c.body_b]);
}

inline PassTarget target_of_pass(const CpuState& state, ContactPass pass, const ContactConstraint& c,
                                 const ManifoldRows& rows, const ManifoldImpulses& impulses, const Slip& slip) {
    const Parameters& p = state.parameters;
    const float load_speed = load_speed_so_far(c.load_speed, rows, impulses);
    const Substep substep = make_substep(substeps_of_contact(c.counts), is_against_static(c.traits), load_speed, p);
    PassTarget target{};
    target.friction = make_friction_target(rows, impulses.normal);
    target.old_share = pass == ContactPass::Solve ? 0.0f : 1.0f;
    const BodyDelta &delta_a = state.deltas[c.body_a], &delta_b = state.deltas[c.body_b];
    const bool is_relax = pass == ContactPass::Relax;
    const bool moves = is_against_static(c.traits) && !is_relax;
    const float half_h = moves ? 0.5f * substep_length(substeps_of_contact(c.counts), p) : 0.0f;
    target.touch = touch_of_pass(slip, rows.meeting, impulses, half_h, is_relax);
    target.normal = make_normal_target(current_separations(rows, c.base_separation, c.traits, delta_a, delta_b), rows,
                                       impulses.normal, pass != ContactPass::Relax, substep, p);
    if (pass == ContactPass::Relax) target.normal.lower = least_relaxed(rows, c.base_separation, impulses, substep);
    return target;
}

/// Instead of the pass that has found the hit, whose result was not put back.
inline ManifoldState pass_over_hit(CpuState& state, const ManifoldState& before, uint index, const ManifoldRows& rows,
                                   const PassTarget& target) {
    const ContactConstraint& c = state.constraints[index];
    const Substep substep =
        make_substep(substeps_of_contact(c.counts), is_against_static(c.traits), c.load_speed, state.parameters);
    const BodyDelta delta_a = shifted(state.deltas[c.body_a], hits_of(state, c.body_a).shift);
    const BodyDelta delta_b = shifted(state.deltas[c.body_b], hits_of(state, c.body_b).shift);
    const float h = substep_length(substeps_of_contact(c.counts), state.parameters);
    const auto falling = [&](uint body, const BodyVelocity& velocity) {
        return falling_acceleration(velocity, state.warm_starts[body], state.properties[body], state.inertias[body],
                                    load_of_body(state, body), h, state.parameters);
    };
    const Hit hit = solve_hit(before.velocities, rows, measure_slip(rows.meeting, c.gap, c.traits, delta_a, delta_b),
                              current_separations(rows, c.base_separation, c.traits, delta_a, delta_b),
                              falling(c.body_b, before.velocities.b) - falling(c.body_a, before.velocities.a),
                              substep.inv_h, state.parameters);
    if (!is_finite_pair(hit.velocities)) return before;
    const auto take = [&](uint body, uint its_traits, const BodyVelocity& was, const BodyVelocity& is) {
        if (was.inverse_mass == 0.0f || !is_pushed(its_traits)) return;
        state.warm_starts[body] = leave_out(state.warm_starts[body], was, is);
        put_hits(state, body, take_hit(hits_of(state, body), was, is, hit.time));
    };
    take(c.body_a, c.traits, before.velocities.a, hit.velocities.a);
    take(c.body_b, c.traits >> k_traits_of_b, before.velocities.b, hit.velocities.b);
    put_contact_hits(state, index, hits_of_contact(state, index) + hit.impulse);
    return end_hit(before, hit, target.old_share);
}

/// A body that contacts do not push may be in many constraints of one colour: nobody writes it. Nor a hub.
inline void put_velocity(CpuState& state, uint index, ContactPass pass, uint tick, uint body, uint its_traits,
                         const BodyVelocity& before, BodyVelocity after) {
    if (after.inverse_mass == 0.0f || !is_pushed(its_traits)) return;
    const ContactConstraint& c = state.constraints[index];
    // After the relax pass no sub-step follows that could have a part.
    if (pass != ContactPass::Relax)
        after = change_in_part(before, after, part_of_change(c.traits, state.inertias[body].traits));
    if ((its_traits & k_trait_hub) == 0)
        state.velocities[body] = after;
    else
        state.hub_changes[index - state.colour_offsets[k_first_hub_colour]] =
            change_of_hub(body, before, after, c.hub_share, tick);
}

inline void pass_over_constraint(CpuState& state, ContactPass pass, uint tick, uint index) {
    ContactConstraint& c = state.constraints[index];
    if (substep_at(tick, c.traits) >= substeps_of_contact(c.counts)) return;
    const ManifoldRows rows = make_rows(c, state.inertias[c.body_a], state.inertias[c.body_b]);
    const ManifoldState before{{state.velocities[c.body_a], state.velocities[c.body_b]}, make_impulses(c), false};
    ManifoldState s = before;
    if (pass == ContactPass::WarmStart) {
        s.velocities = warm_start_manifold(s.velocities, rows, s.impulses);
    } else {
        const Slip slip = slip_of_pass(state, c, rows);
        const PassTarget target = target_of_pass(state, pass, c, rows, s.impulses, slip);
        s = solve_manifold(s, rows, target);
        s.impulses.slip = slip.apart;
        const bool is_hit = s.is_hit && (!has_been_hit(hits_of_contact(state, index)) ||
                                         can_be_hit_again(before, hits_of(state, c.body_a), hits_of(state, c.body_b)));
        if (is_hit && pass == ContactPass::Relax) return; // the next step's
        if (is_hit) s = pass_over_hit(state, before, index, rows, target);
        if (!is_finite_pair(s.velocities)) s = before; // what has gone wrong here is kept from the bodies
        c.friction_impulse = s.impulses.friction;
        c.slip = s.impulses.slip;
        c.normal_impulse = s.impulses.normal;
        c.total_impulse = s.impulses.total;
    }
    put_velocity(state, index, pass, tick, c.body_a, c.traits, before.velocities.a, s.velocities.a);
    put_velocity(state, index, pass, tick, c.body_b, c.traits >> k_traits_of_b, before.velocities.b, s.velocities.b);
}

} // namespace talus::engine
