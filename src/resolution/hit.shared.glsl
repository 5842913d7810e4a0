// SPDX-License-Identifier: MIT
// A hit: bodies that bounce, and close faster than the threshold. It is an event and no load: what it changes is not
// what the next sub-step should start from. It is solved to the end at once, and each point that is hit leaves with e
// times the speed that it came with; a chain of bodies passes it on from sub-step to sub-step.
// Needs resolution/contact.shared.glsl.

// The rows as they are after some slip. A hit needs them: with others it would not keep the energy.
inline Row shift_row(Row row, vec3 d, Slip slip, BodyInertia inertia_a, BodyInertia inertia_b)
{
    vec3 arm = cross3(slip.apart, d);
    precise vec3 arm_a = row.arm_a + arm * slip.share_a;
    precise vec3 arm_b = row.arm_b - arm * slip.share_b;
    row.arm_a = arm_a;
    row.arm_b = arm_b;
    row.turn_a = multiply_inertia(inertia_a, arm_a);
    row.turn_b = multiply_inertia(inertia_b, arm_b);
    return row;
}

inline ManifoldRows shift_rows(ManifoldRows rows, Slip slip, float inverse_masses)
{
    BodyInertia inertia_a = rows.inertia_a;
    BodyInertia inertia_b = rows.inertia_b;
    rows.point_0 = shift_row(rows.point_0, rows.normal, slip, inertia_a, inertia_b);
    rows.point_1 = shift_row(rows.point_1, rows.normal, slip, inertia_a, inertia_b);
    rows.point_2 = shift_row(rows.point_2, rows.normal, slip, inertia_a, inertia_b);
    rows.point_3 = shift_row(rows.point_3, rows.normal, slip, inertia_a, inertia_b);
    rows.tangent_1 = shift_row(rows.tangent_1, rows.t1, slip, inertia_a, inertia_b);
    rows.tangent_2 = shift_row(rows.tangent_2, rows.t2, slip, inertia_a, inertia_b);
    vec4 mass = rows.normal_mass; // 0 where there is no point
    rows.normal_mass = vec4(mass.x > 0.0f ? row_mass(rows.point_0, inverse_masses) : 0.0f,
                            mass.y > 0.0f ? row_mass(rows.point_1, inverse_masses) : 0.0f,
                            mass.z > 0.0f ? row_mass(rows.point_2, inverse_masses) : 0.0f,
                            mass.w > 0.0f ? row_mass(rows.point_3, inverse_masses) : 0.0f);
    rows.friction_mass.x = row_mass(rows.tangent_1, inverse_masses);
    rows.friction_mass.y = row_mass(rows.tangent_2, inverse_masses);
    return couple_points(rows, inverse_masses);
}

struct Hit {
    VelocityPair velocities; // after it
    vec4 impulse;            // N s, along the normal
    float time;              // s, within the sub-step
};

// Of what closes at `velocity`, only what touches within the sub-step bounces. `closing`: the closing_speed of the
// point.
inline bool bounces(float velocity, float mass, float closing, Parameters p)
{
    return mass > 0.0f && -velocity > max(closing, p.restitution_threshold);
}

inline float time_of_bounce(float velocity, float mass, float closing, float inv_h, Parameters p)
{
    precise float time = closing * reciprocal(-velocity * inv_h);
    return bounces(velocity, mass, closing, p) ? time : k_never;
}

// The velocity that a point is to have after the hit, at least.
inline float leaving_velocity(float velocity, float mass, float closing, float restitution, Parameters p)
{
    precise float leaving = -restitution * velocity;
    return bounces(velocity, mass, closing, p) ? leaving : -closing;
}

// When the first point that bounces touches; 0 if none does.
inline float time_of_hit(vec4 velocity, vec4 mass, vec4 closing, float inv_h, Parameters p)
{
    float first = min(min(time_of_bounce(velocity.x, mass.x, closing.x, inv_h, p),
                          time_of_bounce(velocity.y, mass.y, closing.y, inv_h, p)),
                      min(time_of_bounce(velocity.z, mass.z, closing.z, inv_h, p),
                          time_of_bounce(velocity.w, mass.w, closing.w, inv_h, p)));
    return first < k_never ? first : 0.0f;
}

// `v`: the velocities before the pass.
inline Hit solve_hit(VelocityPair v, ManifoldRows rows, Slip slip, vec4 closing, float inv_h, Parameters p)
{
    vec4 velocity = normal_velocities(v, rows, slip);
    float e = rows.restitution;
    float time = time_of_hit(velocity, rows.normal_mass, closing, inv_h, p);
    rows = shift_rows(rows, slip_after(slip, v, time), v.a.inverse_mass + v.b.inverse_mass);
    slip.apart = vec3(0.0f, 0.0f, 0.0f);

    NormalSweep sweep;
    sweep.velocity = normal_velocities(v, rows, slip);
    sweep.impulse = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    velocity = sweep.velocity;
    vec4 mass = rows.normal_mass;
    vec4 leaving = vec4(leaving_velocity(velocity.x, mass.x, closing.x, e, p),
                        leaving_velocity(velocity.y, mass.y, closing.y, e, p),
                        leaving_velocity(velocity.z, mass.z, closing.z, e, p),
                        leaving_velocity(velocity.w, mass.w, closing.w, e, p));
    precise vec4 offset = mass * leaving;
    NormalTarget rigid;
    rigid.mass = mass;
    rigid.offset = offset;
    rigid.lower = sweep.impulse;
    rigid.hit_speed = closing; // not looked at
    for (uint i = 0u; i < k_sweeps_of_fast; i += 1u)
        sweep = sweep_normals(sweep, rows, rigid);

    ManifoldState s;
    s.velocities = apply_normals(v, rows, sweep.impulse);
    s.impulses.normal = sweep.impulse;
    s.impulses.total = sweep.impulse;
    s.impulses.friction = vec3(0.0f, 0.0f, 0.0f);
    s.impulses.moment = vec3(0.0f, 0.0f, 0.0f);
    s.is_hit = true;
    s = solve_friction(s, rows, make_friction_target(rows, sweep.impulse), slip);
    Hit hit;
    hit.velocities = s.velocities;
    hit.impulse = sweep.impulse;
    hit.time = time;
    return hit;
}

// The state after a pass that was a hit: the load that the sub-step has started from stays.
inline ManifoldState end_hit(ManifoldState before, Hit hit, float old_share)
{
    precise vec4 total = before.impulses.total + before.impulses.normal * (1.0f - old_share);
    before.impulses.total = total;
    before.velocities = hit.velocities;
    return before;
}
