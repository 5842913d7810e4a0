// SPDX-License-Identifier: MIT
// The rows of a manifold, solved by sequential impulses (thesis, section 3.4): a normal row for each point; for all
// points together two friction rows at their middle, and one against twisting about the normal.
//
// Differs from the thesis, which has two friction rows for each point: of the twelve rows of a face six were redundant,
// and they were half of the arithmetic.
//
// Symbols: v, w linear and angular velocity; r anchor from the body's centre; d a row's direction; n normal from A to
// B; t1, t2 tangents; K = J M^-1 J^T (equation 3.15 without the inversion); lambda accumulated impulse. A vec4 holds a
// number for each of the four points; a point that is not there has mass 0, and so no impulse.
// Needs resolution/tangents.shared.glsl, body.shared.glsl and softness.shared.glsl.

// ---- one row ----

const uint k_traits_of_b = 4u; // bits that B's traits are shifted by in a constraint

inline bool is_against_static(uint traits)
{
    return (traits & (traits >> k_traits_of_b) & k_trait_movable) == 0u;
}

struct Row {
    vec3 arm_a; // r x d: the part of the row's Jacobian that the angular velocity meets (equation 3.6)
    vec3 arm_b;
    vec3 turn_a; // I^-1 (r x d): what a unit of impulse does to the angular velocity (equation 3.13)
    vec3 turn_b;
};

inline Row make_row(vec3 d, vec3 r_a, vec3 r_b, BodyInertia inertia_a, BodyInertia inertia_b)
{
    Row row;
    row.arm_a = cross3(r_a, d);
    row.arm_b = cross3(r_b, d);
    row.turn_a = multiply_inertia(inertia_a, row.arm_a);
    row.turn_b = multiply_inertia(inertia_b, row.arm_b);
    return row;
}

// J V of equation 3.3; `linear` is d · (v_b - v_a).
inline float row_velocity(Row row, float linear, vec3 w_a, vec3 w_b)
{
    precise float velocity = linear + (dot3(row.arm_b, w_b) - dot3(row.arm_a, w_a));
    return velocity;
}

// J_i M^-1 J_j^T of two rows along the same direction: what a unit of impulse in one does to the velocity of the other.
inline float row_coupling(Row i, Row j, float inverse_masses)
{
    precise float k = inverse_masses + (dot3(i.arm_a, j.turn_a) + dot3(i.arm_b, j.turn_b));
    return k;
}

// 1 / K: the effective mass (equation 3.15).
inline float row_mass(Row row, float inverse_masses)
{
    float k = row_coupling(row, row, inverse_masses);
    return k > 0.0f ? reciprocal(k) : 0.0f;
}

// ---- the rows of a manifold ----

// All that stays the same in the passes of a step.
struct ManifoldRows {
    vec3 normal;
    vec3 t1;
    vec3 t2;
    Row point_0; // along the normal
    Row point_1;
    Row point_2;
    Row point_3;
    Row tangent_1; // at the middle of the points
    Row tangent_2;
    vec3 twist_a; // I^-1 n
    vec3 twist_b;
    vec3 coupling_0; // of point 0 with points 1, 2, 3
    vec3 coupling_1; // of point 1 with points 2 and 3; of point 2 with point 3
    vec4 normal_mass;
    vec3 friction_mass; // t1, t2, twist
    vec4 lever;         // m, of each point from their middle
    float friction;
    float restitution;
    BodyInertia inertia_a;
    BodyInertia inertia_b;
};

// The impulses that a manifold has accumulated in a sub-step.
struct ManifoldImpulses {
    vec4 normal;   // N s
    vec4 total;    // N s, the sum over all sub-steps
    vec3 friction; // N s along t1 and t2, N m s about the normal
    vec3 moment;   // N m s, see Slip
};

inline ManifoldRows couple_points(ManifoldRows rows, float inverse_masses)
{
    rows.coupling_0 = vec3(row_coupling(rows.point_0, rows.point_1, inverse_masses),
                           row_coupling(rows.point_0, rows.point_2, inverse_masses),
                           row_coupling(rows.point_0, rows.point_3, inverse_masses));
    rows.coupling_1 = vec3(row_coupling(rows.point_1, rows.point_2, inverse_masses),
                           row_coupling(rows.point_1, rows.point_3, inverse_masses),
                           row_coupling(rows.point_2, rows.point_3, inverse_masses));
    return rows;
}

inline ManifoldRows make_rows(ContactConstraint c, ContactConstraintPoint p0, ContactConstraintPoint p1,
                              ContactConstraintPoint p2, ContactConstraintPoint p3, BodyInertia inertia_a,
                              BodyInertia inertia_b)
{
    Tangents t = contact_tangents(c.normal);
    ManifoldRows rows;
    rows.normal = c.normal;
    rows.t1 = t.t1;
    rows.t2 = t.t2;
    rows.point_0 = make_row(c.normal, p0.anchor_a, p0.anchor_b, inertia_a, inertia_b);
    rows.point_1 = make_row(c.normal, p1.anchor_a, p1.anchor_b, inertia_a, inertia_b);
    rows.point_2 = make_row(c.normal, p2.anchor_a, p2.anchor_b, inertia_a, inertia_b);
    rows.point_3 = make_row(c.normal, p3.anchor_a, p3.anchor_b, inertia_a, inertia_b);
    rows.tangent_1 = make_row(t.t1, c.centre_a, c.centre_b, inertia_a, inertia_b);
    rows.tangent_2 = make_row(t.t2, c.centre_a, c.centre_b, inertia_a, inertia_b);
    rows.twist_a = multiply_inertia(inertia_a, c.normal);
    rows.twist_b = multiply_inertia(inertia_b, c.normal);
    rows.normal_mass = vec4(p0.normal_mass, p1.normal_mass, p2.normal_mass, p3.normal_mass);
    rows.friction_mass = vec3(c.tangent_mass_1, c.tangent_mass_2, c.twist_mass);
    rows.lever = vec4(p0.lever, p1.lever, p2.lever, p3.lever);
    rows.friction = c.friction;
    rows.restitution = c.restitution;
    rows.inertia_a = inertia_a;
    rows.inertia_b = inertia_b;
    return couple_points(rows, c.inverse_masses);
}

inline ManifoldImpulses make_impulses(ContactConstraint c, ContactConstraintPoint p0, ContactConstraintPoint p1,
                                      ContactConstraintPoint p2, ContactConstraintPoint p3)
{
    ManifoldImpulses impulses;
    impulses.normal = vec4(p0.normal_impulse, p1.normal_impulse, p2.normal_impulse, p3.normal_impulse);
    impulses.total = vec4(p0.total_impulse, p1.total_impulse, p2.total_impulse, p3.total_impulse);
    impulses.friction = vec3(c.tangent_impulse_1, c.tangent_impulse_2, c.twist_impulse);
    impulses.moment = c.moment;
    return impulses;
}

struct VelocityPair {
    BodyVelocity a;
    BodyVelocity b;
};

// Applies normal impulses to B, and their opposites to A (equation 3.13).
inline VelocityPair apply_normals(VelocityPair v, ManifoldRows rows, vec4 impulse)
{
    precise vec3 push = rows.normal * sum4(impulse);
    precise vec3 turn_a = rows.point_0.turn_a * impulse.x + rows.point_1.turn_a * impulse.y +
                          (rows.point_2.turn_a * impulse.z + rows.point_3.turn_a * impulse.w);
    precise vec3 turn_b = rows.point_0.turn_b * impulse.x + rows.point_1.turn_b * impulse.y +
                          (rows.point_2.turn_b * impulse.z + rows.point_3.turn_b * impulse.w);
    precise vec3 linear_a = v.a.linear - push * v.a.inverse_mass;
    precise vec3 linear_b = v.b.linear + push * v.b.inverse_mass;
    precise vec3 angular_a = v.a.angular - turn_a;
    precise vec3 angular_b = v.b.angular + turn_b;
    v.a.linear = linear_a;
    v.b.linear = linear_b;
    v.a.angular = angular_a;
    v.b.angular = angular_b;
    return v;
}

// Applies friction impulses: x and y along the tangents, z about the normal.
inline VelocityPair apply_friction(VelocityPair v, ManifoldRows rows, vec3 impulse)
{
    precise vec3 sideways = rows.t1 * impulse.x + rows.t2 * impulse.y;
    precise vec3 turn_a =
        rows.tangent_1.turn_a * impulse.x + rows.tangent_2.turn_a * impulse.y + rows.twist_a * impulse.z;
    precise vec3 turn_b =
        rows.tangent_1.turn_b * impulse.x + rows.tangent_2.turn_b * impulse.y + rows.twist_b * impulse.z;
    precise vec3 linear_a = v.a.linear - sideways * v.a.inverse_mass;
    precise vec3 linear_b = v.b.linear + sideways * v.b.inverse_mass;
    precise vec3 angular_a = v.a.angular - turn_a;
    precise vec3 angular_b = v.b.angular + turn_b;
    v.a.linear = linear_a;
    v.b.linear = linear_b;
    v.a.angular = angular_a;
    v.b.angular = angular_b;
    return v;
}

// ---- separations ----

// What a manifold's points share of their present separation.
struct Approach {
    float distance; // m: how far the bodies' centres have come apart along the normal since the start of the step
    vec3 normal_a;  // the normal as seen by A before it turned
    vec3 normal_b;
};

// `traits`: the constraint's.
inline Approach measure_approach(vec3 n, uint traits, BodyDelta a, BodyDelta b)
{
    precise vec3 moved = b.position - a.position;
    Approach approach;
    approach.distance = dot3(moved, n);
    approach.normal_a = (traits & k_trait_round) != 0u ? n : rotate_back(a.rotation, n);
    approach.normal_b = (traits & (k_trait_round << k_traits_of_b)) != 0u ? n : rotate_back(b.rotation, n);
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

// ---- slip ----
//
// A pair's anchors met in one point when the contact was found, and have moved apart since. An impulse that acts on the
// two bodies at two points changes their angular momentum, so both are taken to be touched in one point: half way, or
// where the body is that can be pushed, if the other cannot. The rows' arms stay as they are; what is missing, for all
// rows alike, is the slip's part of the velocity, and the moment of the impulses about the anchors.

struct Slip {
    vec3 apart;  // m, from A's anchors to B's
    float share_a; // of `apart` that A's arms are too short by
    float share_b; // that B's arms are too long by
};

// `gap` and `traits`: the constraint's.
inline Slip measure_slip(vec3 gap, uint traits, BodyDelta a, BodyDelta b)
{
    precise vec3 apart = gap + (b.position - a.position);
    bool pushes_a = (traits & k_trait_movable) != 0u;
    bool pushes_b = (traits & (k_trait_movable << k_traits_of_b)) != 0u;
    Slip slip;
    slip.apart = apart;
    slip.share_a = pushes_a ? (pushes_b ? 0.5f : 0.0f) : 1.0f;
    slip.share_b = pushes_b ? (pushes_a ? 0.5f : 0.0f) : 1.0f;
    return slip;
}

inline Slip slip_after(Slip slip, VelocityPair v, float time)
{
    precise vec3 apart = slip.apart + (v.b.linear - v.a.linear) * time;
    slip.apart = apart;
    return slip;
}

// v_b - v_a without the rows' arms.
inline vec3 relative_velocity(VelocityPair v, Slip slip)
{
    precise vec3 spin = v.a.angular * slip.share_a + v.b.angular * slip.share_b;
    precise vec3 velocity = (v.b.linear - v.a.linear) - cross3(spin, slip.apart);
    return velocity;
}

// ---- what the rows of a pass aim at ----
//
// All of it is known before the bodies' velocities are, which matters where a pass waits for the one before.

// The normal rows, put so that the new impulse is max(offset - mass (J V), lower).
struct NormalTarget {
    vec4 mass;
    vec4 offset;
    vec4 lower;
    vec4 hit_speed; // m/s: a point that closes faster has been hit
};

// The speed at which a separation may close within the sub-step.
inline float closing_speed(float separation, float inv_h)
{
    precise float speed = max(separation, 0.0f) * inv_h;
    return speed;
}

// One point's share: x the mass, y the offset. The bias velocity b is that of equation 3.7; see solver.md.
inline vec2 point_target(float separation, float normal_mass, float impulse, bool use_bias, Softness soft, float inv_h,
                         Parameters p)
{
    bool biased = separation <= 0.0f && use_bias;
    float gap = closing_speed(separation, inv_h);
    precise float push = max(soft.bias_rate * min(separation + p.linear_slop, 0.0f), -p.contact_push_speed);
    float bias = separation > 0.0f ? gap : (use_bias ? push : 0.0f);
    precise float mass = normal_mass * (biased ? soft.mass_scale : 1.0f);
    precise float offset = (impulse - (biased ? soft.impulse_scale : 0.0f) * impulse) - mass * bias;
    return vec2(mass, offset);
}

inline vec4 closing_speeds(vec4 separation, float inv_h)
{
    return vec4(closing_speed(separation.x, inv_h), closing_speed(separation.y, inv_h),
                closing_speed(separation.z, inv_h), closing_speed(separation.w, inv_h));
}

const float k_never = 1.0e30f; // m/s, or s

// A point of bodies that bounce is hit when it closes faster than this: so that it touches within the sub-step. What
// overlaps by more than half of that has been there for longer, and is pushed apart.
inline float hit_speed(float separation, float normal_mass, float restitution, float inv_h, Parameters p)
{
    precise float old = -0.5f * separation * inv_h;
    float speed = max(max(closing_speed(separation, inv_h), old), p.restitution_threshold);
    return normal_mass > 0.0f && restitution > 0.0f ? speed : k_never;
}

inline NormalTarget make_normal_target(vec4 separation, ManifoldRows rows, vec4 impulse, bool use_bias,
                                       Substep substep, Parameters p)
{
    Softness soft = substep.soft;
    float inv_h = substep.inv_h;
    vec2 x = point_target(separation.x, rows.normal_mass.x, impulse.x, use_bias, soft, inv_h, p);
    vec2 y = point_target(separation.y, rows.normal_mass.y, impulse.y, use_bias, soft, inv_h, p);
    vec2 z = point_target(separation.z, rows.normal_mass.z, impulse.z, use_bias, soft, inv_h, p);
    vec2 w = point_target(separation.w, rows.normal_mass.w, impulse.w, use_bias, soft, inv_h, p);
    NormalTarget target;
    target.mass = vec4(x.x, y.x, z.x, w.x);
    target.offset = vec4(x.y, y.y, z.y, w.y);
    target.lower = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    target.hit_speed = vec4(hit_speed(separation.x, rows.normal_mass.x, rows.restitution, inv_h, p),
                            hit_speed(separation.y, rows.normal_mass.y, rows.restitution, inv_h, p),
                            hit_speed(separation.z, rows.normal_mass.z, rows.restitution, inv_h, p),
                            hit_speed(separation.w, rows.normal_mass.w, rows.restitution, inv_h, p));
    return target;
}

// Deep overlap is pushed apart in all sub-steps, and the speed that it has got by that is taken back by the relax pass,
// up to the impulses of the whole step.
const float k_fast_push = 0.2f; // m/s; what rests is pushed by a few centimetres a second

inline float least_relaxed(ContactConstraintPoint point, vec3 n, float impulse, float total, Softness soft)
{
    precise float separation = point.base_separation + (dot3(point.anchor_b, n) - dot3(point.anchor_a, n));
    precise float push = -soft.bias_rate * separation;
    precise float least = impulse - total;
    return push > k_fast_push ? min(least, 0.0f) : 0.0f;
}

// The friction rows: impulses stay inside an ellipsoid, with the force limit as its radius along the tangents and the
// torque limit along the twist. A body that spins fast has little friction left against sliding. The surface is Howe
// and Cutkosky's approximation (1996) of what points of friction spread over the face would do.
struct FrictionTarget {
    vec3 radii;         // N s along t1 and t2, N m s about the normal
    vec3 inverse_radii; // 0 where the limit is too small to hold anything
    vec3 sliding_mass;
};

const float k_least_friction = 1.0e-20f; // N s, and N m s: their inverses would leave the range of a float
const float k_most_radii = 1.0e15f;      // that an impulse is taken to lie outside its limit: its square is still a float

// A manifold that slides takes masses in the ratio of the squared limits, and none above its own. Then what is left on
// the rim points against the motion, as the ellipsoid's normal does. With the rows' own masses a box lost 8 % of its
// friction on a slope of 35 degrees, and drifted to the side.
inline FrictionTarget make_friction_target(ManifoldRows rows, vec4 normal_impulse)
{
    precise vec4 moments = normal_impulse * rows.lever;
    precise float force = rows.friction * sum4(normal_impulse);
    precise float torque = rows.friction * sum4(moments);
    float inverse_force = force > k_least_friction ? reciprocal(force) : 0.0f;
    float inverse_torque = torque > k_least_friction ? reciprocal(torque) : 0.0f;
    float force_radius = inverse_force > 0.0f ? force : 0.0f;
    float torque_radius = inverse_torque > 0.0f ? torque : 0.0f;
    precise float lever = torque_radius * inverse_force;
    precise float square_lever = lever * lever;
    vec3 mass = rows.friction_mass;
    float smaller = min(mass.x, mass.y);
    if (square_lever > 0.0f) smaller = min(smaller, mass.z * reciprocal(square_lever));
    precise float twist = smaller * square_lever;
    FrictionTarget target;
    target.radii = vec3(force_radius, force_radius, torque_radius);
    target.inverse_radii = vec3(inverse_force, inverse_force, inverse_torque);
    target.sliding_mass = vec3(smaller, smaller, twist);
    return target;
}

struct PassTarget {
    NormalTarget normal;
    FrictionTarget friction;
    Slip slip;
    float half_h; // s, half of the movement that follows the pass
    float old_share; // 1 where the impulses that a pass starts from are part of the step's sum already
    bool moved_since; // those impulses acted where the bodies were before their last movement: in the relax pass
};

// A body pair and its manifold in the midst of a pass.
struct ManifoldState {
    VelocityPair velocities;
    ManifoldImpulses impulses;
    bool is_hit;
};

// ---- normal rows ----

// J V of the normal rows.
inline vec4 normal_velocities(VelocityPair v, ManifoldRows rows, Slip slip)
{
    vec3 w_a = v.a.angular;
    vec3 w_b = v.b.angular;
    float linear = dot3(relative_velocity(v, slip), rows.normal);
    return vec4(row_velocity(rows.point_0, linear, w_a, w_b), row_velocity(rows.point_1, linear, w_a, w_b),
                row_velocity(rows.point_2, linear, w_a, w_b), row_velocity(rows.point_3, linear, w_a, w_b));
}

// A point that closes fast is no hit where the load alone could have made it fast: a light body under a heavy one is
// thrown about within a sub-step.
inline bool is_hit(float velocity, float mass, float speed, float load)
{
    precise float stopping = -velocity * mass;
    return -velocity > speed && stopping > load;
}

inline bool is_any_hit(vec4 velocity, vec4 mass, vec4 speed, float load)
{
    return is_hit(velocity.x, mass.x, speed.x, load) || is_hit(velocity.y, mass.y, speed.y, load) ||
           is_hit(velocity.z, mass.z, speed.z, load) || is_hit(velocity.w, mass.w, speed.w, load);
}

struct NormalSweep {
    vec4 velocity; // J V, but for what each row's own impulse has changed last
    vec4 impulse;
};

// The normal rows one after the other (equation 3.14, accumulated and clamped). What each impulse does to the other
// rows comes from the coupling, so that the bodies' velocities are touched once.
inline NormalSweep sweep_normals(NormalSweep s, ManifoldRows rows, NormalTarget target)
{
    vec4 old = s.impulse;
    vec4 velocity = s.velocity;
    precise float velocity_0 = velocity.x;
    precise float velocity_1 = velocity.y;
    precise float velocity_2 = velocity.z;
    precise float velocity_3 = velocity.w;
    precise float impulse_0 = max(target.offset.x - target.mass.x * velocity_0, target.lower.x);
    precise float change_0 = impulse_0 - old.x;
    velocity_1 = velocity_1 + rows.coupling_0.x * change_0;
    velocity_2 = velocity_2 + rows.coupling_0.y * change_0;
    velocity_3 = velocity_3 + rows.coupling_0.z * change_0;
    precise float impulse_1 = max(target.offset.y - target.mass.y * velocity_1, target.lower.y);
    precise float change_1 = impulse_1 - old.y;
    velocity_0 = velocity_0 + rows.coupling_0.x * change_1;
    velocity_2 = velocity_2 + rows.coupling_1.x * change_1;
    velocity_3 = velocity_3 + rows.coupling_1.y * change_1;
    precise float impulse_2 = max(target.offset.z - target.mass.z * velocity_2, target.lower.z);
    precise float change_2 = impulse_2 - old.z;
    velocity_0 = velocity_0 + rows.coupling_0.y * change_2;
    velocity_1 = velocity_1 + rows.coupling_1.x * change_2;
    velocity_3 = velocity_3 + rows.coupling_1.z * change_2;
    precise float impulse_3 = max(target.offset.w - target.mass.w * velocity_3, target.lower.w);
    precise float change_3 = impulse_3 - old.w;
    velocity_0 = velocity_0 + rows.coupling_0.z * change_3;
    velocity_1 = velocity_1 + rows.coupling_1.y * change_3;
    velocity_2 = velocity_2 + rows.coupling_1.z * change_3;
    NormalSweep next;
    next.velocity = vec4(velocity_0, velocity_1, velocity_2, velocity_3);
    next.impulse = vec4(impulse_0, impulse_1, impulse_2, impulse_3);
    return next;
}

// One sweep treats the points unlike: a tower of three that stood a little turned on itself was driven round by it, at
// 3 cm/s for ever. Two come close enough. A manifold this fast (m/s) is far from solved, and is solved to the end at
// once: a box that falls flat would be left turning.
const uint k_sweeps = 2u;
const float k_fast = 0.25f;
const uint k_sweeps_of_fast = 8u;

inline ManifoldState solve_normals(ManifoldState s, ManifoldRows rows, NormalTarget target, Slip slip)
{
    NormalSweep sweep;
    sweep.velocity = normal_velocities(s.velocities, rows, slip);
    sweep.impulse = s.impulses.normal;
    s.is_hit = is_any_hit(sweep.velocity, rows.normal_mass, target.hit_speed, sum4(sweep.impulse));
    vec4 v = sweep.velocity;
    float fastest = max(max(abs(v.x), abs(v.y)), max(abs(v.z), abs(v.w)));
    uint sweeps = fastest > k_fast ? k_sweeps_of_fast : k_sweeps;
    for (uint i = 0u; i < sweeps; i += 1u)
        sweep = sweep_normals(sweep, rows, target);
    precise vec4 change = sweep.impulse - s.impulses.normal;
    s.impulses.normal = sweep.impulse;
    s.velocities = apply_normals(s.velocities, rows, change);
    return s;
}

// ---- friction rows ----

inline vec3 limit_each(vec3 v, float limit)
{
    return vec3(clamp_to(v.x, -limit, limit), clamp_to(v.y, -limit, limit), clamp_to(v.z, -limit, limit));
}

// New accumulated friction impulses.
inline vec3 solve_friction_rows(vec3 impulse, vec3 mass, vec3 velocity, FrictionTarget target)
{
    precise vec3 stuck = impulse - mass * velocity;
    vec3 on_sphere = limit_each(multiply3(stuck, target.inverse_radii), k_most_radii);
    if (dot3(on_sphere, on_sphere) <= 1.0f) return multiply3(on_sphere, target.radii);

    precise vec3 sliding = impulse - target.sliding_mass * velocity;
    on_sphere = limit_each(multiply3(sliding, target.inverse_radii), k_most_radii);
    float square = dot3(on_sphere, on_sphere);
    if (square > 1.0f) on_sphere = scale3(on_sphere, inverse_sqrt(square));
    return multiply3(on_sphere, target.radii);
}

// One pass over the friction rows. They come before the normal rows, as keeping bodies apart matters more and the last
// row wins.
inline ManifoldState solve_friction(ManifoldState s, ManifoldRows rows, FrictionTarget target, Slip slip)
{
    vec3 w_a = s.velocities.a.angular;
    vec3 w_b = s.velocities.b.angular;
    vec3 apart = relative_velocity(s.velocities, slip);
    precise vec3 spin = w_b - w_a;
    vec3 velocity = vec3(row_velocity(rows.tangent_1, dot3(apart, rows.t1), w_a, w_b),
                         row_velocity(rows.tangent_2, dot3(apart, rows.t2), w_a, w_b), dot3(spin, rows.normal));
    vec3 impulse = solve_friction_rows(s.impulses.friction, rows.friction_mass, velocity, target);
    precise vec3 change = impulse - s.impulses.friction;
    s.impulses.friction = impulse;
    s.velocities = apply_friction(s.velocities, rows, change);
    return s;
}

// ---- passes ----

// The impulse of all rows together on B, without what the points' rows and the twist add as moments.
inline vec3 whole_impulse(ManifoldImpulses impulses, ManifoldRows rows)
{
    vec3 friction = impulses.friction;
    precise vec3 impulse = rows.normal * sum4(impulses.normal) + (rows.t1 * friction.x + rows.t2 * friction.y);
    return impulse;
}

// Brings the moment of the impulses up to the present slip. `impulse_before` and `moment_before`: of what acted before
// the bodies came to where they are, and is not applied again.
inline ManifoldState turn_by_slip(ManifoldState s, ManifoldRows rows, Slip slip, vec3 impulse_before,
                                  vec3 moment_before)
{
    precise vec3 impulse = whole_impulse(s.impulses, rows) - impulse_before;
    precise vec3 moment = cross3(slip.apart, impulse) + moment_before;
    precise vec3 change = moment - s.impulses.moment;
    vec3 turn_a = multiply_inertia(rows.inertia_a, change);
    vec3 turn_b = multiply_inertia(rows.inertia_b, change);
    precise vec3 angular_a = s.velocities.a.angular - turn_a * slip.share_a;
    precise vec3 angular_b = s.velocities.b.angular - turn_b * slip.share_b;
    s.impulses.moment = moment;
    s.velocities.a.angular = angular_a;
    s.velocities.b.angular = angular_b;
    return s;
}

inline ManifoldState solve_manifold(ManifoldState s, ManifoldRows rows, PassTarget target)
{
    Slip slip = slip_after(target.slip, s.velocities, target.half_h);
    vec4 old = s.impulses.normal;
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    vec3 impulse_before = target.moved_since ? whole_impulse(s.impulses, rows) : none;
    vec3 moment_before = target.moved_since ? s.impulses.moment : none;
    ManifoldState solved = solve_normals(solve_friction(s, rows, target.friction, slip), rows, target.normal, slip);
    precise vec4 total = solved.impulses.total + (solved.impulses.normal - old * target.old_share);
    solved.impulses.total = total;
    return turn_by_slip(solved, rows, slip, impulse_before, moment_before);
}

// The accumulated impulses again, to start from.
inline VelocityPair warm_start_manifold(VelocityPair v, ManifoldRows rows, ManifoldImpulses impulses)
{
    return apply_normals(apply_friction(v, rows, impulses.friction), rows, impulses.normal);
}

// ---- from a manifold to a constraint ----

// Impulses are kept for a whole step, and accumulated in a sub-step. Of bodies in different numbers of sub-steps, one
// cannot be pushed: the other's number holds.
inline ContactConstraint begin_constraint(Manifold manifold, uint manifold_index, float inverse_masses,
                                          BodyInertia inertia_a, BodyInertia inertia_b)
{
    bool pushes_a = (inertia_a.traits & k_trait_movable) != 0u;
    bool pushes_b = (inertia_b.traits & k_trait_movable) != 0u;
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
    c.traits = inertia_a.traits | (inertia_b.traits << k_traits_of_b);
    c.twist_mass = 0.0f;
    c.inverse_masses = inverse_masses;
    c.substeps = max(max(pushes_a ? inertia_a.substeps : 1u, pushes_b ? inertia_b.substeps : 1u), 1u);
    precise float share = reciprocal(float(c.substeps));
    precise float tangent_impulse_1 = manifold.tangent_impulse_1 * share;
    precise float tangent_impulse_2 = manifold.tangent_impulse_2 * share;
    precise float twist_impulse = manifold.twist_impulse * share;
    c.tangent_impulse_1 = tangent_impulse_1;
    c.tangent_impulse_2 = tangent_impulse_2;
    c.twist_impulse = twist_impulse;
    c.moment = vec3(0.0f, 0.0f, 0.0f);
    c.reserved_1 = 0.0f;
    c.gap = vec3(0.0f, 0.0f, 0.0f);
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

inline ContactConstraint finish_constraint(ContactConstraint c, vec3 position_a, vec3 position_b, BodyInertia inertia_a,
                                           BodyInertia inertia_b)
{
    precise vec3 gap = (position_b - position_a) + (c.centre_b - c.centre_a);
    c.gap = gap;
    Tangents t = contact_tangents(c.normal);
    Row tangent_1 = make_row(t.t1, c.centre_a, c.centre_b, inertia_a, inertia_b);
    Row tangent_2 = make_row(t.t2, c.centre_a, c.centre_b, inertia_a, inertia_b);
    c.tangent_mass_1 = row_mass(tangent_1, c.inverse_masses);
    c.tangent_mass_2 = row_mass(tangent_2, c.inverse_masses);
    precise float k = dot3(c.normal, multiply_inertia(inertia_a, c.normal)) +
                      dot3(c.normal, multiply_inertia(inertia_b, c.normal));
    c.twist_mass = k > 0.0f ? reciprocal(k) : 0.0f;
    return c;
}

inline ContactConstraintPoint prepare_point(ManifoldPoint old, ContactConstraint c, BodyInertia inertia_a,
                                            BodyInertia inertia_b)
{
    Row row = make_row(c.normal, old.anchor_a, old.anchor_b, inertia_a, inertia_b);
    precise vec3 apart = old.anchor_b - old.anchor_a;
    precise vec3 arm = old.anchor_a - c.centre_a;
    precise float base = old.separation - dot3(apart, c.normal);
    precise float impulse = old.normal_impulse * reciprocal(float(c.substeps));
    ContactConstraintPoint point;
    point.anchor_a = old.anchor_a;
    point.anchor_b = old.anchor_b;
    point.base_separation = base;
    point.normal_mass = row_mass(row, c.inverse_masses);
    point.lever = length3(arm);
    point.normal_impulse = impulse;
    point.total_impulse = 0.0f;
    point.hit_impulse = 0.0f;
    return point;
}

// In the place of a point that is not there.
inline ContactConstraintPoint no_point()
{
    ContactConstraintPoint point;
    point.anchor_a = vec3(0.0f, 0.0f, 0.0f);
    point.base_separation = 0.0f;
    point.anchor_b = vec3(0.0f, 0.0f, 0.0f);
    point.normal_mass = 0.0f;
    point.lever = 0.0f;
    point.normal_impulse = 0.0f;
    point.total_impulse = 0.0f;
    point.hit_impulse = 0.0f;
    return point;
}

// ---- from a constraint back to its manifold ----

// What a point passes on: the last sub-step's impulse, taken for all of them. One that was hit in the last sub-steps
// alone must not be pushed as hard in all of the next step: then it is the sum.
inline float impulse_of_step(ContactConstraintPoint point, ContactConstraint c)
{
    precise float lasting = point.normal_impulse * float(c.substeps);
    precise float twice = 2.0f * point.total_impulse;
    return max(lasting > twice ? point.total_impulse : lasting, 0.0f);
}

// Impulses of the whole step, and the sub-steps that their load asks for in the next one. The load is a running mean:
// an impact is no reason for finer sub-steps.
inline Manifold finish_manifold(Manifold manifold, ContactConstraint c, vec4 normal_impulse, float inverse_mass_a,
                               float inverse_mass_b, Parameters p)
{
    precise float whole = float(c.substeps);
    precise float tangent_impulse_1 = c.tangent_impulse_1 * whole;
    precise float tangent_impulse_2 = c.tangent_impulse_2 * whole;
    precise float twist_impulse = c.twist_impulse * whole;
    float weights = weights_on(sum4(normal_impulse), inverse_mass_a, inverse_mass_b, p);
    manifold.tangent_impulse_1 = tangent_impulse_1;
    manifold.tangent_impulse_2 = tangent_impulse_2;
    manifold.twist_impulse = twist_impulse;
    precise float mean = manifold.weights + k_newest_weight * (weights - manifold.weights);
    uint wanted = wanted_substeps(mean, p);
    bool on_trial = manifold.idle_steps >= k_trial;
    bool idle = on_trial || 2u * wanted <= manifold.substeps;
    manifold.idle_steps = idle ? manifold.idle_steps + 1u : 0u;
    uint patience = on_trial ? k_trial + k_trial_steps : k_patience;
    if (wanted > manifold.substeps) {
        manifold.substeps = wanted;
        manifold.idle_steps = 0u;
    } else if (manifold.idle_steps >= patience) {
        manifold.substeps = max(wanted, manifold.substeps / 2u);
        manifold.idle_steps = manifold.substeps > wanted ? patience - k_halving_steps : 0u;
    }
    manifold.weights = mean;
    return manifold;
}
