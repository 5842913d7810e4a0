// SPDX-License-Identifier: MIT
// A contact constraint in an invocation's hand, and the passes over it. Before this file the kernel defines
//   uint slot_of(uint body), where a body's velocity, delta and warm start are found
//   BodyVelocity load_velocity(uint slot), void store_velocity(uint slot, BodyVelocity velocity)
//   the same for BodyDelta and BodyWarmStart, with delta and warm_start in their names
//   const bool k_bounces, whether there may be a restitution above 0
//   const bool k_hubs, whether a body may be a hub, and void put_change(uint index, HubChange change)
// as these live in buffers in one kernel and in shared memory in another. The CPU's counterpart is
// contact_passes.h.
// Reads: Inertias. Reads and writes: Constraints (their impulses).

layout(std430) buffer Constraints { ContactConstraintCells constraints[]; };
layout(std430) readonly buffer Inertias { BodyInertiaCells inertias[]; };

const uint k_warm_start = 0u;
const uint k_solve = 1u;       // with bias
const uint k_solve_again = 2u; // further iterations in the same sub-step
const uint k_relax = 3u;       // without bias

// The constraint in hand.
uint body_a;
uint body_b;
uint slot_a;
uint slot_b;
uint traits;
uint substeps;
vec3 gap_at_start;
vec4 base_separation;
ManifoldRows rows;
ManifoldImpulses impulses;

void hold_constraint(ContactConstraint c, BodyInertia inertia_a, BodyInertia inertia_b)
{
    body_a = c.body_a;
    body_b = c.body_b;
    slot_a = slot_of(body_a);
    slot_b = slot_of(body_b);
    traits = c.traits;
    substeps = c.substeps;
    gap_at_start = c.gap;
    base_separation = c.base_separation;
    rows = make_rows(c, inertia_a, inertia_b);
    impulses = make_impulses(c);
}

void take_constraint(uint index)
{
    ContactConstraint c = unpack(constraints[index]);
    hold_constraint(c, unpack(inertias[c.body_a]), unpack(inertias[c.body_b]));
}

// In the last cells of the record: see ContactConstraint.
void put_back_impulses(uint index)
{
    constraints[index].cell_11.xyz = floatBitsToUint(impulses.friction);
    constraints[index].cell_12.xyz = floatBitsToUint(impulses.moment);
    constraints[index].cell_13 = floatBitsToUint(impulses.normal);
    constraints[index].cell_14 = floatBitsToUint(impulses.total);
}

struct DeltaPair {
    BodyDelta a;
    BodyDelta b;
};

DeltaPair load_deltas() { return DeltaPair(load_delta(slot_a), load_delta(slot_b)); }

PassTarget target_of_pass(uint pass, DeltaPair moved)
{
    Substep substep = make_substep(substeps, is_against_static(traits), parameters);
    bool moves = pass != k_relax && is_against_static(traits);
    PassTarget target;
    target.friction = make_friction_target(rows, impulses.normal);
    target.old_share = pass == k_solve ? 0.0 : 1.0;
    target.moved_since = pass == k_relax;
    target.slip = measure_slip(rows.meeting, gap_at_start, traits, moved.a, moved.b);
    target.half_h = moves ? 0.5 * substep_length(substeps, parameters) : 0.0;
    target.normal = make_normal_target(current_separations(rows, base_separation, traits, moved.a, moved.b), rows,
                                       impulses.normal, pass != k_relax, substep, parameters);
    if (pass == k_relax) target.normal.lower = least_relaxed(rows, base_separation, impulses, substep.soft);
    return target;
}

VelocityPair load_velocities() { return VelocityPair(load_velocity(slot_a), load_velocity(slot_b)); }

void put_hit(uint slot, BodyVelocity before, BodyVelocity after, float time)
{
    if (before.inverse_mass == 0.0) return;
    store_warm_start(slot, take_hit(load_warm_start(slot), before, after, time));
    groupMemoryBarrier(); // the body's own invocation reads it
}

// Instead of the pass that has found the hit, whose result was not put back.
ManifoldState pass_over_hit(uint index, ManifoldState before, float old_share)
{
    DeltaPair moved = load_deltas();
    Slip slip = measure_slip(rows.meeting, gap_at_start, traits, moved.a, moved.b);
    Substep substep = make_substep(substeps, is_against_static(traits), parameters);
    vec4 separations = current_separations(rows, base_separation, traits, moved.a, moved.b);
    vec4 closing = closing_speeds(separations, substep.inv_h);
    Hit hit = solve_hit(before.velocities, rows, slip, closing, substep.inv_h, parameters);
    if (!is_finite_pair(hit.velocities)) return before;
    put_hit(slot_a, before.velocities.a, hit.velocities.a, hit.time);
    put_hit(slot_b, before.velocities.b, hit.velocities.b, hit.time);
    constraints[index].cell_15 = floatBitsToUint(uintBitsToFloat(constraints[index].cell_15) + hit.impulse);
    return end_hit(before, hit, old_share);
}

// A body that contacts cannot push may be in many constraints of one colour: nobody writes it. Nor a hub.
void put_velocity(uint index, uint body, uint slot, uint its_traits, BodyVelocity before, BodyVelocity after)
{
    if (after.inverse_mass == 0.0) return;
    if (k_hubs && (its_traits & k_trait_hub) != 0u)
        put_change(index, change_of_hub(body, before, after, unpack(inertias[body])));
    else
        store_velocity(slot, after);
}

void put_velocities(uint index, VelocityPair before, VelocityPair after)
{
    put_velocity(index, body_a, slot_a, traits, before.a, after.a);
    put_velocity(index, body_b, slot_b, traits >> k_traits_of_b, before.b, after.b);
}

// One pass over the constraint in hand, whose index it is.
void pass_over_constraint(uint pass, uint index, PassTarget target, VelocityPair velocities)
{
    ManifoldState before = ManifoldState(velocities, impulses, false);
    if (pass == k_warm_start) {
        put_velocities(index, before.velocities, warm_start_manifold(before.velocities, rows, impulses));
        return;
    }
    ManifoldState solved = solve_manifold(before, rows, target);
    if (k_bounces && solved.is_hit) {
        if (pass == k_relax) return; // the next step's
        ManifoldState hit = pass_over_hit(index, before, target.old_share);
        impulses = hit.impulses;
        put_velocities(index, before.velocities, hit.velocities);
    } else if (is_finite_pair(solved.velocities)) {
        impulses = solved.impulses;
        put_velocities(index, before.velocities, solved.velocities);
    } else { // what has gone wrong here is kept from the bodies
        put_velocities(index, before.velocities, before.velocities);
    }
}
