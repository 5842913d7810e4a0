// SPDX-License-Identifier: MIT
// A contact constraint in an invocation's hand, and the passes over it. Before this file the kernel defines
//   BodyVelocity load_velocity(uint body)
//   void store_velocity(uint body, BodyVelocity velocity)
// as velocities live in a buffer in one kernel and in shared memory in another. The CPU's counterpart is
// contact_passes.h.
// Reads: Inertias, Deltas. Reads and writes: Constraints, ConstraintPoints (their impulses).

layout(std430) buffer Constraints { ContactConstraint constraints[]; };
layout(std430) buffer ConstraintPoints { ContactConstraintPoint constraint_points[]; };
layout(std430) readonly buffer Inertias { BodyInertia inertias[]; };
layout(std430) coherent buffer Deltas { BodyDelta deltas[]; };

const uint k_warm_start = 0u;
const uint k_solve = 1u; // with bias
const uint k_relax = 2u; // without
const uint k_restitution = 3u;

// The constraint in hand.
uint body_a;
uint body_b;
bool against_static;
uint substeps;
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
    against_static = c.against_static == 1u;
    substeps = c.substeps;
    rows = make_rows(c, p0, p1, p2, p3, inertia_a, inertia_b);
    impulses = make_impulses(c, p0, p1, p2, p3);
}

void put_back_impulses(uint index)
{
    constraints[index].tangent_impulse_1 = impulses.friction.x;
    constraints[index].tangent_impulse_2 = impulses.friction.y;
    constraints[index].twist_impulse = impulses.friction.z;
    constraint_points[4u * index].normal_impulse = impulses.normal.x;
    constraint_points[4u * index].max_normal_impulse = impulses.most.x;
    constraint_points[4u * index + 1u].normal_impulse = impulses.normal.y;
    constraint_points[4u * index + 1u].max_normal_impulse = impulses.most.y;
    constraint_points[4u * index + 2u].normal_impulse = impulses.normal.z;
    constraint_points[4u * index + 2u].max_normal_impulse = impulses.most.z;
    constraint_points[4u * index + 3u].normal_impulse = impulses.normal.w;
    constraint_points[4u * index + 3u].max_normal_impulse = impulses.most.w;
}

float separation_of(uint point, Approach approach)
{
    return current_separation(constraint_points[point], approach);
}

PassTarget target_of_pass(uint pass, uint index)
{
    PassTarget target;
    target.friction = make_friction_target(rows, impulses.normal);
    uint point = 4u * index;
    if (pass == k_restitution) {
        vec4 approach_speed = vec4(constraint_points[point].approach_speed, constraint_points[point + 1u].approach_speed,
                                   constraint_points[point + 2u].approach_speed,
                                   constraint_points[point + 3u].approach_speed);
        target.normal =
            make_bounce_target(approach_speed, rows, impulses, constraints[index].restitution, parameters);
        return target;
    }
    BodyDelta delta_a = deltas[body_a]; // a coherent block's member is no argument: NVIDIA's compiler refuses it
    BodyDelta delta_b = deltas[body_b];
    Approach approach = measure_approach(rows.normal, delta_a, delta_b);
    vec4 separation = vec4(separation_of(point, approach), separation_of(point + 1u, approach),
                           separation_of(point + 2u, approach), separation_of(point + 3u, approach));
    Substep substep = make_substep(substeps, against_static, parameters);
    target.normal = make_normal_target(separation, rows, impulses.normal, pass == k_solve, substep.soft, substep.inv_h,
                                       parameters);
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
        s = solve_normals(s, rows, target.normal);
    else
        s = solve_manifold(s, rows, target);
    impulses = s.impulses;
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (s.velocities.a.inverse_mass > 0.0) store_velocity(body_a, s.velocities.a);
    if (s.velocities.b.inverse_mass > 0.0) store_velocity(body_b, s.velocities.b);
}
