// SPDX-License-Identifier: MIT
// A contact constraint in an invocation's hand, and the passes over it. Before this file the kernel defines
//   BodyVelocity load_velocity(uint body)
//   void store_velocity(uint body, BodyVelocity velocity)
//   Substep substep_of(uint substeps, bool against_static)
// as these live in buffers in one kernel and in shared memory in another. The CPU's counterpart is
// contact_passes.h.
// Reads: Inertias, Deltas. Reads and writes: Constraints, ConstraintPoints (their impulses).

layout(std430) buffer Constraints { ContactConstraint constraints[]; };
layout(std430) buffer ConstraintPoints { ContactConstraintPoint constraint_points[]; };
layout(std430) readonly buffer Inertias { BodyInertia inertias[]; };
layout(std430) coherent buffer Deltas { BodyDelta deltas[]; };

const uint k_warm_start = 0u;
const uint k_solve = 1u;       // with bias
const uint k_solve_again = 2u; // further iterations in the same sub-step
const uint k_relax = 3u;       // without bias
const uint k_restitution = 4u;

// The constraint in hand.
uint body_a;
uint body_b;
uint traits;
uint substeps;
vec3 gap;
ManifoldRows rows;
ManifoldImpulses impulses;

void take_constraint(uint index)
{
    ContactConstraint c = constraints[index];
    BodyInertia inertia_a = inertias[c.body_a];
    BodyInertia inertia_b = inertias[c.body_b];
    ContactConstraintPoint p0 = constraint_points[4u * index];
    ContactConstraintPoint p1 = constraint_points[4u * index + 1u];
    ContactConstraintPoint p2 = constraint_points[4u * index + 2u];
    ContactConstraintPoint p3 = constraint_points[4u * index + 3u];
    body_a = c.body_a;
    body_b = c.body_b;
    traits = c.traits;
    substeps = c.substeps;
    gap = c.gap;
    rows = make_rows(c, p0, p1, p2, p3, inertia_a, inertia_b);
    impulses = make_impulses(c, p0, p1, p2, p3);
}

void put_back_point(uint point, float impulse, float total, float approach)
{
    constraint_points[point].normal_impulse = impulse;
    constraint_points[point].total_impulse = total;
    constraint_points[point].approach_speed = approach;
}

void put_back_impulses(uint index)
{
    constraints[index].tangent_impulse_1 = impulses.friction.x;
    constraints[index].tangent_impulse_2 = impulses.friction.y;
    constraints[index].twist_impulse = impulses.friction.z;
    constraints[index].moment = impulses.moment;
    put_back_point(4u * index, impulses.normal.x, impulses.total.x, impulses.approach.x);
    put_back_point(4u * index + 1u, impulses.normal.y, impulses.total.y, impulses.approach.y);
    put_back_point(4u * index + 2u, impulses.normal.z, impulses.total.z, impulses.approach.z);
    put_back_point(4u * index + 3u, impulses.normal.w, impulses.total.w, impulses.approach.w);
}

float separation_of(uint point, Approach approach)
{
    return current_separation(constraint_points[point], approach);
}

float least_of(uint point, float impulse, float total, Softness soft)
{
    return least_relaxed(constraint_points[point], rows.normal, impulse, total, soft);
}

PassTarget target_of_pass(uint pass, uint index)
{
    PassTarget target;
    target.friction = make_friction_target(rows, impulses.normal);
    target.old_share = pass == k_solve ? 0.0 : 1.0;
    uint point = 4u * index;
    BodyDelta delta_a = deltas[body_a]; // a coherent block's member is no argument: NVIDIA's compiler refuses it
    BodyDelta delta_b = deltas[body_b];
    target.slip = measure_slip(gap, traits, delta_a, delta_b);
    if (pass == k_restitution) {
        target.normal = make_bounce_target(rows, impulses, constraints[index].restitution, parameters);
        return target;
    }
    Approach approach = measure_approach(rows.normal, traits, delta_a, delta_b);
    vec4 separation = vec4(separation_of(point, approach), separation_of(point + 1u, approach),
                           separation_of(point + 2u, approach), separation_of(point + 3u, approach));
    Substep substep = substep_of(substeps, is_against_static(traits));
    target.normal = make_normal_target(separation, rows, impulses.normal, pass != k_relax, substep.soft, substep.inv_h,
                                       parameters);
    if (pass == k_relax) {
        vec4 impulse = impulses.normal;
        vec4 total = impulses.total;
        target.normal.lower = vec4(least_of(point, impulse.x, total.x, substep.soft),
                                   least_of(point + 1u, impulse.y, total.y, substep.soft),
                                   least_of(point + 2u, impulse.z, total.z, substep.soft),
                                   least_of(point + 3u, impulse.w, total.w, substep.soft));
    }
    return target;
}

// One pass over the constraint in hand.
void pass_over_constraint(uint pass, PassTarget target)
{
    ManifoldState s;
    s.velocities.a = load_velocity(body_a);
    s.velocities.b = load_velocity(body_b);
    s.impulses = impulses;
    if (pass == k_warm_start)
        s.velocities = warm_start_manifold(s.velocities, rows, impulses);
    else if (pass == k_restitution)
        s = bounce_manifold(s, rows, target);
    else
        s = solve_manifold(s, rows, target);
    impulses = s.impulses;
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (s.velocities.a.inverse_mass > 0.0) store_velocity(body_a, s.velocities.a);
    if (s.velocities.b.inverse_mass > 0.0) store_velocity(body_b, s.velocities.b);
}
