// SPDX-License-Identifier: MIT
// A contact constraint in an invocation's hand, and the passes over it. Before this file the kernel defines
//   uint slot_of(uint body), where a body's velocity is found
//   BodyVelocity load_velocity(uint slot)
//   void store_velocity(uint slot, BodyVelocity velocity)
//   BodyDelta load_delta(uint body, uint slot)
//   const bool k_bounces, whether there may be a restitution above 0; then it includes stored_hits.glsl behind this file, else
//     no_hits.glsl
//   const bool k_hubs, whether a body may be a hub, and void put_change(uint index, HubChange change)
//   const bool k_multirate_islands, whether a body may have more sub-steps than a contact of it
// as these live in buffers in one kernel and in shared memory in another. The CPU's counterpart is
// contact_passes.h.
// Reads: Inertias, Properties, Loads. Reads and writes: Constraints (their impulses), WarmStarts.

#include "resolution/body_load.glsl"

layout(std430) buffer Constraints { ContactConstraintCellBlock constraints[]; };
layout(std430) readonly buffer Inertias { BodyInertiaCells inertias[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) coherent buffer WarmStarts { BodyWarmStartCells warm_starts[]; };

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
BodyWarmStart load_warm_start(uint body)
{
    BodyWarmStartCells warm = warm_starts[body];
    return unpack(warm);
}

// stored_hits.glsl or no_hits.glsl
BodyHits load_hits(uint body);
void store_hits(uint body, BodyHits hits);
vec4 load_contact_hits(uint index);
void store_contact_hits(uint index, vec4 hits);

bool some_bounce() { return k_bounces; }

const uint k_warm_start = 0u;
const uint k_solve = 1u;       // with bias
const uint k_solve_again = 2u; // further iterations in the same sub-step
const uint k_relax = 3u;       // without bias

// The constraint in hand.
uint body_a;
uint body_b;
uint slot_a;
uint slot_b;
uint counts;
uint traits;
uint substeps;
float hub_share;
float part_a; // see part_of_change
float part_b;
float load_speed;
vec3 gap_at_start;
vec4 base_separation;
ManifoldRows rows;
ManifoldImpulses impulses;
bool has_other_impulses; // than its record

// Called where the bodies of the constraint in hand are known, and nothing has been made of its record yet. In solve_in_order.glsl it
// loads their velocities; else it does nothing.
void look_early();

// `of_hub`: false where its colour is none for hubs. A constant in each call, so that the compiler leaves out what hubs need.
void take_constraint(uint index, bool of_hub)
{
    ContactConstraint c = unpack_ContactConstraint(constraints, index);
    if (!of_hub) c.traits &= ~(k_trait_hub | (k_trait_hub << k_traits_of_b));
    BodyInertia inertia_a = unpack(inertias[c.body_a]);
    BodyInertia inertia_b = unpack(inertias[c.body_b]);
    body_a = c.body_a;
    body_b = c.body_b;
    if (!of_hub) look_early();
    slot_a = slot_of(body_a);
    slot_b = slot_of(body_b);
    counts = c.counts;
    traits = c.traits;
    substeps = substeps_of_contact(counts);
    hub_share = c.hub_share;
    part_a = part_of_change(traits, inertia_a.traits);
    part_b = part_of_change(traits, inertia_b.traits);
    load_speed = c.load_speed;
    gap_at_start = c.gap;
    base_separation = c.base_separation;
    rows = make_rows(c, inertia_a, inertia_b);
    impulses = make_impulses(c);
    has_other_impulses = false;
}

// If a pass has changed them. In the last cells of the record: see ContactConstraint.
void put_back_impulses(uint index)
{
    if (has_other_impulses) {
        cell_in_block(constraints, index, k_first_changing).xyz = floatBitsToUint(impulses.friction); // beside hub_share
        cell_in_block(constraints, index, k_first_changing + 1u) = uvec4(floatBitsToUint(impulses.slip), floatBitsToUint(load_speed));
        cell_in_block(constraints, index, k_first_changing + 2u) = floatBitsToUint(impulses.normal);
        cell_in_block(constraints, index, k_first_changing + 3u) = floatBitsToUint(impulses.total);
    }
}

// What the contact in hand needs to know of its sub-steps, with such a load. Defined behind this file, by solve_substeps.glsl or
// solve_contacts.glsl.
Substep substep_in_hand(float present_load_speed);

vec3 slip_of_target; // m: Slip::apart

// Whether bodies have moved in this step: not in its first tick, whose number the relax pass comes with, too.
bool have_moved(uint pass, uint tick) { return tick > 0u || pass == k_relax; }

// `loads_movements`: false where no body has moved, which saves loading that.
PassTarget target_of_pass(uint pass, bool loads_movements)
{
    BodyDelta delta_a = no_delta();
    BodyDelta delta_b = no_delta();
    if (loads_movements) {
        delta_a = load_delta(body_a, slot_a);
        delta_b = load_delta(body_b, slot_b);
    }
    float present_load_speed = load_speed_so_far(load_speed, rows, impulses);
    Substep substep = substep_in_hand(present_load_speed);
    PassTarget target;
    target.friction = make_friction_target(rows, impulses.normal);
    target.old_share = choose(pass == k_solve, 0.0, 1.0);
    Slip slip = measure_slip(rows.meeting, gap_at_start, traits, delta_a, delta_b);
    bool moves = is_against_static(traits) && pass != k_relax;
    float half_h = choose(moves, 0.5 * substep_length(substeps, parameters), 0.0);
    target.touch = touch_of_pass(slip, rows.meeting, impulses, half_h, pass == k_relax);
    slip_of_target = slip.apart;
    target.normal = make_normal_target(current_separations(rows, base_separation, traits, delta_a, delta_b), rows,
                                       impulses.normal, pass != k_relax, substep, parameters);
    if (pass == k_relax) target.normal.lower = least_relaxed(rows, base_separation, impulses, substep);
    return target;
}

VelocityPair load_velocities()
{
    VelocityPair velocities;
    velocities.a = load_velocity(slot_a);
    velocities.b = load_velocity(slot_b);
    return velocities;
}

ManifoldState begin_pass(VelocityPair velocities)
{
    ManifoldState s;
    s.velocities = velocities;
    s.impulses = impulses;
    s.is_hit = false;
    return s;
}

void put_hit(uint body, uint its_traits, BodyVelocity before, BodyVelocity after, float time)
{
    if (before.inverse_mass == 0.0 || !is_pushed(its_traits)) return;
    BodyWarmStart warm = load_warm_start(body);
    warm_starts[body] = pack(leave_out(warm, before, after));
    store_hits(body, take_hit(load_hits(body), before, after, time));
    groupMemoryBarrier(); // the body's own invocation reads it
}

bool can_be_hit(uint index, ManifoldState before)
{
    return !has_been_hit(load_contact_hits(index)) || can_be_hit_again(before, load_hits(body_a), load_hits(body_b));
}

vec3 falling_acceleration_of(uint body, BodyVelocity velocity)
{
    float h = substep_length(substeps, parameters);
    BodyInertia inertia = unpack(inertias[body]);
    return falling_acceleration(velocity, load_warm_start(body), unpack(properties[body]), inertia, load_of_body(body, inertia), h,
                                parameters);
}

// Instead of the pass that has found the hit, whose result was not put back.
ManifoldState pass_over_hit(uint index, float old_share)
{
    BodyDelta delta_a = shifted(load_delta(body_a, slot_a), load_hits(body_a).shift);
    BodyDelta delta_b = shifted(load_delta(body_b, slot_b), load_hits(body_b).shift);
    Slip slip = measure_slip(rows.meeting, gap_at_start, traits, delta_a, delta_b);
    Substep substep = make_substep(substeps, is_against_static(traits), load_speed, parameters);
    vec4 separations = current_separations(rows, base_separation, traits, delta_a, delta_b);
    ManifoldState before = begin_pass(load_velocities());
    precise vec3 falling = falling_acceleration_of(body_b, before.velocities.b) -
                           falling_acceleration_of(body_a, before.velocities.a);
    Hit hit = solve_hit(before.velocities, rows, slip, separations, falling, substep.inv_h, parameters);
    if (!is_finite_pair(hit.velocities)) return before;
    put_hit(body_a, traits, before.velocities.a, hit.velocities.a, hit.time);
    put_hit(body_b, traits >> k_traits_of_b, before.velocities.b, hit.velocities.b, hit.time);
    store_contact_hits(index, load_contact_hits(index) + hit.impulse);
    return end_hit(before, hit, old_share);
}

// A body that contacts do not push may be in many constraints of one colour: nobody writes it. Nor a hub.
void put_velocity(uint index, uint tick, uint body, uint slot, uint its_traits, float part, BodyVelocity before,
                  BodyVelocity after)
{
    if (after.inverse_mass != 0.0 && is_pushed(its_traits)) {
        if (k_multirate_islands) after = change_in_part(before, after, part);
        if (k_hubs && (its_traits & k_trait_hub) != 0u)
            put_change(index, change_of_hub(body, before, after, hub_share, tick));
        else
            store_velocity(slot, after);
    }
}

// After the relax pass no sub-step follows that could have a part.
void put_velocities(uint index, uint pass, uint tick, VelocityPair before, VelocityPair after)
{
    put_velocity(index, tick, body_a, slot_a, traits, choose(pass == k_relax, 1.0, part_a), before.a, after.a);
    put_velocity(index, tick, body_b, slot_b, traits >> k_traits_of_b, choose(pass == k_relax, 1.0, part_b), before.b, after.b);
}

// What a pass over the constraint in hand, whose index it is, makes of its bodies' velocities.
VelocityPair solve_constraint(uint pass, uint index, PassTarget target, VelocityPair velocities)
{
    if (pass == k_warm_start) {
        velocities = warm_start_manifold(velocities, rows, impulses);
    } else {
        ManifoldState before = begin_pass(velocities);
        ManifoldState solved = solve_manifold(before, rows, target);
        solved.impulses.slip = slip_of_target;
        bool is_hit = k_bounces && solved.is_hit && can_be_hit(index, before);
        bool is_of_next_step = is_hit && pass == k_relax;
        if (is_hit && !is_of_next_step) solved = pass_over_hit(index, target.old_share);
        if (!is_of_next_step && is_finite_pair(solved.velocities)) { // what has gone wrong here is kept from the bodies
            impulses = solved.impulses;
            has_other_impulses = true;
            velocities = solved.velocities;
        }
    }
    return velocities;
}

void pass_over_constraint(uint pass, uint tick, uint index, PassTarget target)
{
    VelocityPair before = load_velocities();
    put_velocities(index, pass, tick, before, solve_constraint(pass, index, target, before));
}
