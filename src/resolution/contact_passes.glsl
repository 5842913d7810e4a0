// SPDX-License-Identifier: MIT
// The passes over one contact constraint. Before this file the kernel defines
//   BodyVelocity load_velocity(uint body)
//   void store_velocity(uint body, BodyVelocity velocity)
// as velocities live in a buffer in one kernel and in shared memory in another. The CPU's counterpart is
// contact_passes.h.
// Reads: Constraints, Inertias, Deltas. Reads and writes: ConstraintPoints.

layout(std430) readonly buffer Constraints { ContactConstraint constraints[]; };
layout(std430) buffer ConstraintPoints { ContactConstraintPoint constraint_points[]; };
layout(std430) readonly buffer Inertias { BodyInertia inertias[]; };
layout(std430) coherent buffer Deltas { BodyDelta deltas[]; };

const uint k_warm_start = 0u;
const uint k_solve = 1u; // with bias
const uint k_relax = 2u; // without
const uint k_restitution = 3u;

void pass_over_constraint(uint pass, uint index)
{
    ContactConstraint c = constraints[index];
    if (pass == k_restitution && c.restitution == 0.0) return;
    PointState s;
    s.velocities.a = load_velocity(c.body_a);
    s.velocities.b = load_velocity(c.body_b);
    BodyInertia inertia_a = inertias[c.body_a];
    BodyInertia inertia_b = inertias[c.body_b];
    Tangents t = contact_tangents(c.normal);
    Softness soft = contact_softness(c.against_static == 1u, parameters);
    BodyDelta delta_a = no_delta();
    BodyDelta delta_b = no_delta();
    if (pass == k_solve || pass == k_relax) {
        delta_a = deltas[c.body_a];
        delta_b = deltas[c.body_b];
    }
    Approach approach = measure_approach(c.normal, delta_a, delta_b);
    for (uint i = 4u * index; i < 4u * index + c.point_count; ++i) {
        s.point = constraint_points[i];
        if (pass == k_warm_start) {
            s.velocities = apply_impulse(s.velocities, point_impulse(s.point, c.normal, t), s.point.anchor_a,
                                         s.point.anchor_b, inertia_a, inertia_b);
            continue;
        }
        if (pass == k_restitution) {
            s = apply_point_restitution(s, c.normal, c.restitution, inertia_a, inertia_b, parameters);
        } else {
            float separation = current_separation(s.point, approach);
            s = solve_point(s, c.normal, t, c.friction, separation, pass == k_solve, soft, inertia_a, inertia_b,
                            parameters);
        }
        constraint_points[i].normal_impulse = s.point.normal_impulse;
        constraint_points[i].tangent_impulse_1 = s.point.tangent_impulse_1;
        constraint_points[i].tangent_impulse_2 = s.point.tangent_impulse_2;
        constraint_points[i].max_normal_impulse = s.point.max_normal_impulse;
    }
    // A body that contacts cannot push may be in many constraints of one colour: nobody writes it.
    if (s.velocities.a.inverse_mass > 0.0) store_velocity(c.body_a, s.velocities.a);
    if (s.velocities.b.inverse_mass > 0.0) store_velocity(c.body_b, s.velocities.b);
}
