// SPDX-License-Identifier: MIT
// The rows of a manifold, solved by sequential impulses (thesis, section 3.4): a normal row for each point; for all points
// together two friction rows at their middle, and one against twisting about the normal.
//
// Differs from the thesis, which has two friction rows for each point: of the twelve rows of a face six were redundant,
// and they were half of the arithmetic.
//
// Symbols: v, w linear and angular velocity; r anchor from the body's centre; n normal from A to B; t1, t2 tangents;
// K = J M^-1 J^T (equation 3.15 without the inversion); lambda accumulated impulse.

// 1 / K for a row with direction `d` at the anchors: the effective mass (equations 3.6 to 3.15).
inline float effective_mass(vec3 d, vec3 r_a, vec3 r_b, float inverse_mass_a, BodyInertia inertia_a,
                            float inverse_mass_b, BodyInertia inertia_b)
{
    vec3 arm_a = cross3(r_a, d);
    vec3 arm_b = cross3(r_b, d);
    precise float k = inverse_mass_a + inverse_mass_b + dot3(arm_a, multiply_inertia(inertia_a, arm_a)) +
                      dot3(arm_b, multiply_inertia(inertia_b, arm_b));
    return k > 0.0f ? reciprocal(k) : 0.0f;
}

// Velocity of B's anchor as seen from A's: J V of equation 3.3 before it is taken along a direction.
inline vec3 relative_velocity(BodyVelocity a, BodyVelocity b, vec3 r_a, vec3 r_b)
{
    precise vec3 v = b.linear + cross3(b.angular, r_b) - a.linear - cross3(a.angular, r_a);
    return v;
}

struct VelocityPair {
    BodyVelocity a;
    BodyVelocity b;
};

// Applies the impulse P to B and -P to A (equation 3.13).
inline VelocityPair apply_impulse(VelocityPair v, vec3 impulse, vec3 r_a, vec3 r_b, BodyInertia inertia_a,
                                  BodyInertia inertia_b)
{
    precise vec3 linear_a = v.a.linear - impulse * v.a.inverse_mass;
    precise vec3 linear_b = v.b.linear + impulse * v.b.inverse_mass;
    precise vec3 angular_a = v.a.angular - multiply_inertia(inertia_a, cross3(r_a, impulse));
    precise vec3 angular_b = v.b.angular + multiply_inertia(inertia_b, cross3(r_b, impulse));
    v.a.linear = linear_a;
    v.b.linear = linear_b;
    v.a.angular = angular_a;
    v.b.angular = angular_b;
    return v;
}

// Applies the angular impulse L about the normal to B and -L to A.
inline VelocityPair apply_twist(VelocityPair v, vec3 n, float impulse, BodyInertia inertia_a, BodyInertia inertia_b)
{
    vec3 twist = scale3(n, impulse);
    precise vec3 angular_a = v.a.angular - multiply_inertia(inertia_a, twist);
    precise vec3 angular_b = v.b.angular + multiply_inertia(inertia_b, twist);
    v.a.angular = angular_a;
    v.b.angular = angular_b;
    return v;
}

// What a manifold's points share of their present separation.
struct Approach {
    float distance; // m: how far the bodies' centres have come apart along the normal since the start of the step
    vec3 normal_a;  // the normal as seen by A before it turned
    vec3 normal_b;
};

inline Approach measure_approach(vec3 n, BodyDelta a, BodyDelta b)
{
    precise vec3 moved = b.position - a.position;
    Approach approach;
    approach.distance = dot3(moved, n);
    approach.normal_a = rotate_back(a.rotation, n);
    approach.normal_b = rotate_back(b.rotation, n);
    return approach;
}

// Separation now: what it was, and how far the anchors have moved since along the normal (equation 3.16). To turn the
// normal back once is cheaper than to turn every anchor.
inline float current_separation(ContactConstraintPoint point, Approach approach)
{
    precise float separation = point.base_separation + approach.distance + dot3(point.anchor_b, approach.normal_b) -
                               dot3(point.anchor_a, approach.normal_a);
    return separation;
}

struct Softness {
    float bias_rate;     // 1/s
    float mass_scale;    // 1 for a rigid row
    float impulse_scale; // 0 for a rigid row
};

inline Softness contact_softness(bool against_static, Parameters p)
{
    Softness s;
    s.bias_rate = against_static ? p.static_bias_rate : p.bias_rate;
    s.mass_scale = against_static ? p.static_mass_scale : p.mass_scale;
    s.impulse_scale = against_static ? p.static_impulse_scale : p.impulse_scale;
    return s;
}

// What the normal row aims at in a pass: the bias velocity b of equation 3.7 and how soft the row is.
inline Softness row_softness(float separation, bool use_bias, Softness soft)
{
    Softness rigid;
    rigid.bias_rate = 0.0f;
    rigid.mass_scale = 1.0f;
    rigid.impulse_scale = 0.0f;
    return separation <= 0.0f && use_bias ? soft : rigid;
}

inline float row_bias(float separation, bool use_bias, Softness soft, Parameters p)
{
    precise float gap = separation * p.inv_h; // may close within the sub-step, not more
    precise float push = max(soft.bias_rate * min(separation + p.linear_slop, 0.0f), -p.contact_push_speed);
    if (separation > 0.0f) return gap;
    return use_bias ? push : 0.0f;
}

// New accumulated normal impulse (equation 3.14, accumulated and clamped to push only).
inline float solve_normal_row(ContactConstraintPoint point, float normal_velocity, float bias, Softness soft)
{
    precise float change = -point.normal_mass * soft.mass_scale * (normal_velocity + bias) -
                           soft.impulse_scale * point.normal_impulse;
    precise float impulse = max(point.normal_impulse + change, 0.0f);
    return impulse;
}

// What presses a manifold together. Times the coefficient, it is the limit of its friction.
struct Pressure {
    float force;  // N s: the sum of the normal impulses
    float torque; // N m s: the same, each times its lever
};

inline Pressure no_pressure()
{
    Pressure p;
    p.force = 0.0f;
    p.torque = 0.0f;
    return p;
}

inline Pressure add_pressure(Pressure p, ContactConstraintPoint point)
{
    precise float force = p.force + point.normal_impulse;
    precise float torque = p.torque + point.normal_impulse * point.lever;
    p.force = force;
    p.torque = torque;
    return p;
}

const float k_least_friction = 1.0e-20f; // N s, and N m s
const float k_most_radii = 1.0e15f;      // that an impulse is taken to lie outside its limit: its square is still a float

inline vec3 limit_each(vec3 v, float limit)
{
    return vec3(clamp_to(v.x, -limit, limit), clamp_to(v.y, -limit, limit), clamp_to(v.z, -limit, limit));
}

// New accumulated friction impulses: x and y along the tangents, z the twist. They are held inside an ellipsoid, with the
// force limit as its radius along the tangents and the torque limit along the twist: a body that spins fast has little
// friction left against sliding. The surface is Howe and Cutkosky's approximation (1996) of what points of friction
// spread over the face would do.
//
// A manifold that slides takes masses in the ratio of the squared limits, and none above its own. Then what is left on
// the rim points against the motion, as the ellipsoid's normal does. With the rows' own masses a box lost 8 % of its
// friction on a slope of 35 degrees, and drifted to the side.
inline vec3 solve_friction_rows(vec3 impulse, vec3 mass, vec3 velocity, Pressure limit)
{
    // Limits too small to matter hold nothing: their inverses would leave the range of a float.
    float inverse_force = limit.force > k_least_friction ? reciprocal(limit.force) : 0.0f;
    float inverse_torque = limit.torque > k_least_friction ? reciprocal(limit.torque) : 0.0f;
    vec3 radii = vec3(inverse_force > 0.0f ? limit.force : 0.0f, inverse_force > 0.0f ? limit.force : 0.0f,
                      inverse_torque > 0.0f ? limit.torque : 0.0f);
    vec3 inverse_radii = vec3(inverse_force, inverse_force, inverse_torque);
    precise vec3 stuck = impulse - mass * velocity;
    vec3 on_sphere = limit_each(multiply3(stuck, inverse_radii), k_most_radii);
    if (dot3(on_sphere, on_sphere) <= 1.0f) return multiply3(on_sphere, radii);

    precise float lever = radii.z * inverse_force;
    precise float square_lever = lever * lever;
    float smaller = min(mass.x, mass.y);
    if (square_lever > 0.0f) smaller = min(smaller, mass.z * reciprocal(square_lever));
    precise vec3 sliding_mass = vec3(smaller, smaller, smaller * square_lever);
    precise vec3 sliding = impulse - sliding_mass * velocity;
    on_sphere = limit_each(multiply3(sliding, inverse_radii), k_most_radii);
    float square = dot3(on_sphere, on_sphere);
    if (square > 1.0f) on_sphere = scale3(on_sphere, inverse_sqrt(square));
    return multiply3(on_sphere, radii);
}

// A body pair and its manifold in the midst of a pass of the solver.
struct ManifoldState {
    VelocityPair velocities;
    ContactConstraint c;
};

// One pass over the friction rows. They come before the normal rows, as keeping bodies apart matters more and the last
// row wins.
inline ManifoldState solve_friction(ManifoldState s, Tangents t, Pressure pressure, BodyInertia inertia_a,
                                    BodyInertia inertia_b)
{
    vec3 r_a = s.c.centre_a;
    vec3 r_b = s.c.centre_b;
    vec3 dv = relative_velocity(s.velocities.a, s.velocities.b, r_a, r_b);
    precise vec3 spin = s.velocities.b.angular - s.velocities.a.angular;
    precise float force_limit = s.c.friction * pressure.force;
    precise float torque_limit = s.c.friction * pressure.torque;
    Pressure limit;
    limit.force = force_limit;
    limit.torque = torque_limit;
    vec3 old = vec3(s.c.tangent_impulse_1, s.c.tangent_impulse_2, s.c.twist_impulse);
    vec3 mass = vec3(s.c.tangent_mass_1, s.c.tangent_mass_2, s.c.twist_mass);
    vec3 velocity = vec3(dot3(dv, t.t1), dot3(dv, t.t2), dot3(spin, s.c.normal));
    vec3 impulse = solve_friction_rows(old, mass, velocity, limit);
    precise vec3 change = impulse - old;
    precise vec3 sideways = t.t1 * change.x + t.t2 * change.y;
    s.c.tangent_impulse_1 = impulse.x;
    s.c.tangent_impulse_2 = impulse.y;
    s.c.twist_impulse = impulse.z;
    s.velocities = apply_impulse(s.velocities, sideways, r_a, r_b, inertia_a, inertia_b);
    s.velocities = apply_twist(s.velocities, s.c.normal, change.z, inertia_a, inertia_b);
    return s;
}

// The accumulated friction again, to start from.
inline ManifoldState start_friction(ManifoldState s, Tangents t, BodyInertia inertia_a, BodyInertia inertia_b)
{
    precise vec3 sideways = t.t1 * s.c.tangent_impulse_1 + t.t2 * s.c.tangent_impulse_2;
    s.velocities = apply_impulse(s.velocities, sideways, s.c.centre_a, s.c.centre_b, inertia_a, inertia_b);
    s.velocities = apply_twist(s.velocities, s.c.normal, s.c.twist_impulse, inertia_a, inertia_b);
    return s;
}

// A body pair and a point in the midst of a pass of the solver.
struct PointState {
    VelocityPair velocities;
    ContactConstraintPoint point;
};

// One pass over the normal row of a point.
inline PointState solve_point(PointState s, vec3 n, float separation, bool use_bias, Softness soft,
                              BodyInertia inertia_a, BodyInertia inertia_b, Parameters p)
{
    vec3 r_a = s.point.anchor_a;
    vec3 r_b = s.point.anchor_b;
    vec3 dv = relative_velocity(s.velocities.a, s.velocities.b, r_a, r_b);
    float bias = row_bias(separation, use_bias, soft, p);
    float impulse = solve_normal_row(s.point, dot3(dv, n), bias, row_softness(separation, use_bias, soft));
    precise float change = impulse - s.point.normal_impulse;
    s.point.normal_impulse = impulse;
    s.point.max_normal_impulse = max(s.point.max_normal_impulse, impulse);
    s.velocities = apply_impulse(s.velocities, scale3(n, change), r_a, r_b, inertia_a, inertia_b);
    return s;
}

// The accumulated normal impulse again, to start from.
inline PointState start_point(PointState s, vec3 n, BodyInertia inertia_a, BodyInertia inertia_b)
{
    s.velocities = apply_impulse(s.velocities, scale3(n, s.point.normal_impulse), s.point.anchor_a, s.point.anchor_b,
                                 inertia_a, inertia_b);
    return s;
}

// Restitution, once at the end of the step: a point that was hit faster than the threshold leaves with e times the
// speed of its approach.
inline PointState apply_point_restitution(PointState s, vec3 n, float restitution, BodyInertia inertia_a,
                                          BodyInertia inertia_b, Parameters p)
{
    if (s.point.approach_speed > -p.restitution_threshold || s.point.max_normal_impulse == 0.0f) return s;
    vec3 dv = relative_velocity(s.velocities.a, s.velocities.b, s.point.anchor_a, s.point.anchor_b);
    Softness rigid = row_softness(1.0f, false, contact_softness(false, p));
    precise float bias = restitution * s.point.approach_speed;
    float impulse = solve_normal_row(s.point, dot3(dv, n), bias, rigid);
    precise float change = impulse - s.point.normal_impulse;
    s.point.normal_impulse = impulse;
    s.velocities =
        apply_impulse(s.velocities, scale3(n, change), s.point.anchor_a, s.point.anchor_b, inertia_a, inertia_b);
    return s;
}

// A constraint without the middle of its points yet.
inline ContactConstraint begin_constraint(Manifold manifold, uint manifold_index)
{
    ContactConstraint c;
    c.body_a = manifold.body_a;
    c.body_b = manifold.body_b;
    c.manifold = manifold_index;
    c.point_count = manifold.point_count;
    c.normal = manifold.normal;
    c.friction = manifold.friction;
    c.centre_a = vec3(0.0f, 0.0f, 0.0f);
    c.tangent_mass_1 = 0.0f;
    c.centre_b = vec3(0.0f, 0.0f, 0.0f);
    c.tangent_mass_2 = 0.0f;
    c.restitution = manifold.restitution;
    c.against_static = 0u;
    c.twist_mass = 0.0f;
    c.reserved_1 = 0.0f;
    c.tangent_impulse_1 = manifold.tangent_impulse_1;
    c.tangent_impulse_2 = manifold.tangent_impulse_2;
    c.twist_impulse = manifold.twist_impulse;
    c.reserved_2 = 0.0f;
    return c;
}

inline ContactConstraint add_to_centre(ContactConstraint c, ManifoldPoint point)
{
    precise float share = reciprocal(float(c.point_count));
    c.centre_a = add_scaled(c.centre_a, point.anchor_a, share);
    c.centre_b = add_scaled(c.centre_b, point.anchor_b, share);
    return c;
}

inline ContactConstraint finish_constraint(ContactConstraint c, Tangents t, BodyVelocity a, BodyVelocity b,
                                           BodyInertia inertia_a, BodyInertia inertia_b)
{
    c.tangent_mass_1 =
        effective_mass(t.t1, c.centre_a, c.centre_b, a.inverse_mass, inertia_a, b.inverse_mass, inertia_b);
    c.tangent_mass_2 =
        effective_mass(t.t2, c.centre_a, c.centre_b, a.inverse_mass, inertia_a, b.inverse_mass, inertia_b);
    precise float k = dot3(c.normal, multiply_inertia(inertia_a, c.normal)) +
                      dot3(c.normal, multiply_inertia(inertia_b, c.normal));
    c.twist_mass = k > 0.0f ? reciprocal(k) : 0.0f;
    c.against_static = (inertia_a.movable & inertia_b.movable) ^ 1u;
    return c;
}

inline ContactConstraintPoint prepare_point(ManifoldPoint old, ContactConstraint c, BodyVelocity a, BodyVelocity b,
                                            BodyInertia inertia_a, BodyInertia inertia_b)
{
    ContactConstraintPoint point;
    point.anchor_a = old.anchor_a;
    point.anchor_b = old.anchor_b;
    precise vec3 apart = old.anchor_b - old.anchor_a;
    precise float base = old.separation - dot3(apart, c.normal);
    precise vec3 arm = old.anchor_a - c.centre_a;
    point.base_separation = base;
    point.normal_mass =
        effective_mass(c.normal, old.anchor_a, old.anchor_b, a.inverse_mass, inertia_a, b.inverse_mass, inertia_b);
    point.lever = length3(arm);
    point.approach_speed = dot3(relative_velocity(a, b, old.anchor_a, old.anchor_b), c.normal);
    point.normal_impulse = old.normal_impulse;
    point.max_normal_impulse = 0.0f;
    return point;
}
