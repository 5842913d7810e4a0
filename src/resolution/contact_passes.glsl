// SPDX-License-Identifier: MIT
// The passes over one contact constraint. Before this file the kernel defines
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

void pass_over_constraint(uint pass, uint index)
{
    ManifoldState s;
    s.c = constraints[index];
    vec3 n = s.c.normal;
    if (pass == k_restitution && s.c.restitution == 0.0) return;
    s.velocities.a = load_velocity(s.c.body_a);
    s.velocities.b = load_velocity(s.c.body_b);
    BodyInertia inertia_a = inertias[s.c.body_a];
    BodyInertia inertia_b = inertias[s.c.body_b];
    Tangents t = contact_tangents(n);
    Softness soft = contact_softness(s.c.against_static == 1u, parameters);
    BodyDelta delta_a = no_delta();
    BodyDelta delta_b = no_delta();
    uint first = 4u * index;
    uint end = first + s.c.point_count;
    if (pass == k_solve || pass == k_relax) {
        delta_a = deltas[s.c.body_a];
        delta_b = deltas[s.c.body_b];
        Pressure pressure = no_pressure();
        for (uint i = first; i < end; ++i)
            pressure = add_pressure(pressure, constraint_points[i]);
        s = solve_friction(s, t, pressure, inertia_a, inertia_b);
        constraints[index].tangent_impulse_1 = s.c.tangent_impulse_1;
        constraints[index].tangent_impulse_2 = s.c.tangent_impulse_2;
        constraints[index].twist_impulse = s.c.twist_impulse;
    } else if (pass == k_warm_start) {
        s = start_friction(s, t, inertia_a, inertia_b);
    }
    Approach approach = measure_approach(n, delta_a, delta_b);
    PointState p;
    p.velocities = s.velocities;
    for (uint i = first; i < end; ++i) {
        p.point = constraint_points[i];
        if (pass == k_warm_start) {
            p = start_point(p, n, inertia_a, inertia_b);
            continue;
        }
        if (pass == k_restitution) {
            p = apply_point_restitution(p, n, s.c.restitution, inertia_a, inertia_b, parameters);
        } else {
            float separation = current_separation(p.point, approach);
            p = solve_point(p, n, separation, pass == k_solve, soft, inertia_a, inertia_b, parameters);
        }
        constraint_points[i].normal_impulse = p.point.normal_impulse;
        constraint_points[i].max_normal_impulse = p.point.max_normal_impulse;
    }
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (p.velocities.a.inverse_mass > 0.0) store_velocity(s.c.body_a, p.velocities.a);
    if (p.velocities.b.inverse_mass > 0.0) store_velocity(s.c.body_b, p.velocities.b);
}
