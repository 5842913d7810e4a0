// SPDX-License-Identifier: MIT
// A pass over a manifold: its rows, solved by sequential impulses (thesis, section 3.4).
//
// Differs from the thesis, which has two friction rows for each point: of the twelve rows of a face six were redundant,
// and they were half of the arithmetic.
// Needs resolution/manifold_rows.shared.glsl and softness.shared.glsl.

// The impulses that a manifold has accumulated in a sub-step.
struct ManifoldImpulses {
    vec4 normal;   // N s
    vec4 total;    // N s, the sum over all sub-steps
    vec3 friction; // N s along the frame's x and y, N m s about its z
    vec3 slip;     // m: Slip::apart as it was when they last acted
};

inline ManifoldImpulses make_impulses(ContactConstraint c)
{
    ManifoldImpulses impulses;
    impulses.normal = c.normal_impulse;
    impulses.total = c.total_impulse;
    impulses.friction = c.friction_impulse;
    impulses.slip = c.slip;
    return impulses;
}

// ---- separations ----

// Of the four points now: what they were, and how far the anchors have moved since along the normal (equation 3.16). To
// turn the normal back into each body, as that was before it turned, is cheaper than to turn every anchor.
// `traits`: the constraint's.
inline vec4 current_separations(ManifoldRows rows, vec4 base, uint traits, BodyDelta a, BodyDelta b)
{
    Meeting m = rows.meeting;
    vec3 n = m.frame.z;
    vec3 normal_a = choose((traits & k_trait_round) != 0u, n, rotate_back(a.rotation, n));
    vec3 normal_b = choose((traits & (k_trait_round << k_traits_of_b)) != 0u, n, rotate_back(b.rotation, n));
    precise vec3 moved = b.position - a.position;
    precise vec3 turned = normal_b - normal_a;
    precise float distance = dot3(moved, n) + (dot3(m.arms.b, normal_b) - dot3(m.arms.a, normal_a));
    precise vec4 turning = rows.x * dot3(turned, m.frame.x) + rows.y * dot3(turned, m.frame.y);
    precise vec4 separations = base + (distance + turning);
    return separations;
}

// At the start of the step, where nothing has moved.
inline vec4 first_separations(ManifoldRows rows, vec4 base)
{
    precise vec3 apart = rows.meeting.arms.b - rows.meeting.arms.a;
    precise vec4 separations = base + dot3(apart, rows.meeting.frame.z);
    return separations;
}

// ---- slip ----
//
// The middle of the points was one place when the contact was found, and has moved apart since as the bodies carry it.
// An impulse that acts on the two bodies at two places changes their angular momentum, so both are taken to be touched
// at one: half way, or where the body is that can be pushed, if the other cannot. Their arms lead there. K stays as it is.

struct Slip {
    vec3 apart;    // m, from A's middle to B's
    float share_a; // of `apart` that A's arm is too short by
    float share_b; // that B's arm is too long by
};

inline float largest_diagonal(BodyInertia m) { return max(m.xx, max(m.yy, m.zz)); }

// K knows no slip. Where it would grow to more than twice what it is taken for, each pass would overshoot the one before,
// and impulses between light bodies that fly past each other would never end: there the slip is cut short, by this.
inline float slip_share(vec3 apart, float share_a, float share_b, Meeting m)
{
    precise float yielding = share_a * share_a * largest_diagonal(m.inertia_a) +
                             share_b * share_b * largest_diagonal(m.inertia_b);
    precise float growth = yielding * dot3(apart, apart);
    if (all_lanes(growth <= m.inverse_masses)) return 1.0f;
    precise float square = m.inverse_masses * reciprocal(growth);
    return choose_active(!(growth <= m.inverse_masses), square_root(square), 1.0f);
}

// `gap` and `traits`: the constraint's.
inline Slip measure_slip(Meeting m, vec3 gap, uint traits, BodyDelta a, BodyDelta b)
{
    precise vec3 apart = gap + (b.position - a.position);
    bool pushes_a = (traits & k_trait_movable) != 0u;
    bool pushes_b = (traits & (k_trait_movable << k_traits_of_b)) != 0u;
    Slip slip;
    slip.share_a = choose(pushes_a, choose(pushes_b, 0.5f, 0.0f), 1.0f);
    slip.share_b = choose(pushes_b, choose(pushes_a, 0.5f, 0.0f), 1.0f);
    slip.apart = scale3(apart, slip_share(apart, slip.share_a, slip.share_b, m));
    return slip;
}

inline Arms slipped_arms(Arms arms, Slip slip)
{
    arms.a = add_scaled(arms.a, slip.apart, slip.share_a);
    arms.b = add_scaled(arms.b, slip.apart, -slip.share_b);
    return arms;
}

// Where the bodies meet in a pass, and what has to be made up for there.
struct Touch {
    Arms arms;
    float ahead_a; // s: the velocity there is that of the arm which it would have after so long; impulses act on it as it is
    float ahead_b;
    vec3 moment; // N m s on A, the opposite on B: see slipped_moment
};

// The impulses accumulated so far have acted where the bodies met before. What they turn these by is brought up to where they
// meet now.
inline vec3 slipped_moment(Slip slip, Axes frame, ManifoldImpulses impulses)
{
    vec3 accumulated = to_world(frame, vec3(impulses.friction.x, impulses.friction.y, sum4(impulses.normal)));
    precise vec3 since = slip.apart - impulses.slip;
    return scale3(cross3(since, accumulated), min(slip.share_a, slip.share_b)); // 0 but between two that can be pushed
}

inline Touch touch_at(Arms arms)
{
    Touch touch;
    touch.arms = arms;
    touch.ahead_a = 0.0f;
    touch.ahead_b = 0.0f;
    touch.moment = vec3(0.0f, 0.0f, 0.0f);
    return touch;
}

// `half_h`: s, half of the movement that follows the pass where one of the bodies cannot be pushed, else 0. `moved_since`: the
// impulses that the pass starts from acted where the bodies were before their last movement, as in the relax pass.
inline Touch touch_of_pass(Slip slip, Meeting m, ManifoldImpulses impulses, float half_h, bool moved_since)
{
    precise float ahead_a = slip.share_a * half_h;
    precise float ahead_b = slip.share_b * half_h;
    Touch touch = touch_at(slipped_arms(m.arms, slip));
    touch.ahead_a = ahead_a;
    touch.ahead_b = ahead_b;
    touch.moment = choose(moved_since, touch.moment, slipped_moment(slip, m.frame, impulses));
    return touch;
}

// V as the rows see it, where `touch` says that the bodies meet.
inline SpatialVector relative_velocity(VelocityPair v, Axes frame, Touch touch)
{
    precise vec3 moving = v.b.linear - v.a.linear;
    vec3 linear = velocity_between(moving, v.a.angular, v.b.angular, touch.arms);
    bool is_ahead = touch.ahead_a + touch.ahead_b > 0.0f;
    if (any_lane(is_ahead)) {
        precise vec3 spin = v.a.angular * touch.ahead_a + v.b.angular * touch.ahead_b;
        vec3 linear_ahead = add_scaled(linear, cross3(spin, moving), -1.0f);
        linear = choose_active(is_ahead, linear_ahead, linear);
    }
    precise vec3 angular = v.b.angular - v.a.angular;
    SpatialVector relative;
    relative.linear = to_local(frame, linear);
    relative.angular = to_local(frame, angular);
    return relative;
}

// What a contact is as heavy as (heaviness): the load speed of the last step, or what the impulses of this one have done so
// far. Light bodies between a heavy one and the ground may stop it and throw it back within one step.
inline float load_speed_so_far(float load_speed, ManifoldRows rows, ManifoldImpulses impulses)
{
    precise float so_far = sum4(impulses.total) * rows.meeting.inverse_masses;
    return max(load_speed, so_far);
}

// ---- what the rows of a pass aim at ----
//
// All of it is known before the bodies' velocities are, which matters where a pass waits for the one before.

// The normal rows, put so that the new impulse is max(offset - mass (J V), lower).
struct NormalTarget {
    vec4 mass;
    vec4 offset;
    vec4 lower;
    vec4 hit_speed;   // m/s: a point that closes faster has been hit
    float let_go;     // see let_go_of_thrown
    float push_speed; // m/s
};

// The speed at which a separation may close within the sub-step.
inline float closing_speed(float separation, float inv_h)
{
    precise float speed = max(separation, 0.0f) * inv_h;
    return speed;
}

// One point's share: x the mass, y the offset. The bias velocity b is that of equation 3.7; see solver.md.
inline vec2 point_target(float separation, float normal_mass, float impulse, bool use_bias, Substep substep,
                         Parameters p)
{
    bool biased = separation <= 0.0f && use_bias;
    Softness soft = substep.soft;
    float gap = closing_speed(separation, substep.inv_h);
    precise float push = max(soft.bias_rate * min(separation + p.linear_slop, 0.0f), -substep.push_speed);
    precise float bias = gap + choose(use_bias, push, 0.0f); // one of the two is 0, as neither slop nor push speed is negative
    precise float mass = normal_mass * choose(biased, soft.mass_scale, 1.0f);
    precise float offset = (impulse - choose(biased, soft.impulse_scale, 0.0f) * impulse) - mass * bias;
    return vec2(mass, offset);
}

inline vec4 closing_speeds(vec4 separation, float inv_h)
{
    return vec4(closing_speed(separation.x, inv_h), closing_speed(separation.y, inv_h),
                closing_speed(separation.z, inv_h), closing_speed(separation.w, inv_h));
}

const float k_never = 1.0e30f; // m/s, or s

// A point of bodies that bounce is hit when it closes faster than this: so that it touches within the sub-step. What
// overlaps by more than twice its way in the sub-step has been there for longer, and is pushed apart.
inline float hit_speed(float separation, float normal_mass, float restitution, float inv_h, Parameters p)
{
    float closing = max(closing_speed(separation, inv_h), closing_speed(-0.5f * separation, inv_h));
    float speed = max(closing, p.restitution_threshold);
    return choose(normal_mass > 0.0f && restitution > 0.0f, speed, k_never);
}

inline NormalTarget make_normal_target(vec4 separation, ManifoldRows rows, vec4 impulse, bool use_bias,
                                       Substep substep, Parameters p)
{
    float inv_h = substep.inv_h;
    vec2 x = point_target(separation.x, rows.normal_mass.x, impulse.x, use_bias, substep, p);
    vec2 y = point_target(separation.y, rows.normal_mass.y, impulse.y, use_bias, substep, p);
    vec2 z = point_target(separation.z, rows.normal_mass.z, impulse.z, use_bias, substep, p);
    vec2 w = point_target(separation.w, rows.normal_mass.w, impulse.w, use_bias, substep, p);
    NormalTarget target;
    target.mass = vec4(x.x, y.x, z.x, w.x);
    target.offset = vec4(x.y, y.y, z.y, w.y);
    target.lower = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    target.let_go = substep.let_go;
    target.push_speed = substep.push_speed;
    // To ask each point, and later whether it is hit, takes as long as a sweep: most worlds have nothing that bounces.
    target.hit_speed = vec4(k_never, k_never, k_never, k_never);
    if (any_lane(rows.restitution > 0.0f)) {
        target.hit_speed = vec4(hit_speed(separation.x, rows.normal_mass.x, rows.restitution, inv_h, p),
                                hit_speed(separation.y, rows.normal_mass.y, rows.restitution, inv_h, p),
                                hit_speed(separation.z, rows.normal_mass.z, rows.restitution, inv_h, p),
                                hit_speed(separation.w, rows.normal_mass.w, rows.restitution, inv_h, p));
    }
    return target;
}

// Deep overlap is pushed apart in all sub-steps, and the speed that it has got by that is taken back by the relax pass.
// That is never more than the push speed, and never more than the impulses of the whole step. Without the first limit a
// light body under a heavy one that has just hit it was left with the heavy one's momentum.
const float k_fast_push = 0.2f; // m/s; what rests is pushed by a few centimetres a second

inline float least_of_point(float first_separation, float normal_mass, float impulse, float total, Substep substep)
{
    precise float push = -substep.soft.bias_rate * first_separation;
    precise float pulled = normal_mass * min(push, substep.push_speed);
    precise float least = max(impulse - total, -pulled);
    return choose(push > k_fast_push, min(least, 0.0f), 0.0f);
}

inline vec4 least_relaxed(ManifoldRows rows, vec4 base, ManifoldImpulses impulses, Substep substep)
{
    vec4 first = first_separations(rows, base);
    vec4 mass = rows.normal_mass;
    vec4 impulse = impulses.normal;
    vec4 total = impulses.total;
    return vec4(least_of_point(first.x, mass.x, impulse.x, total.x, substep),
                least_of_point(first.y, mass.y, impulse.y, total.y, substep),
                least_of_point(first.z, mass.z, impulse.z, total.z, substep),
                least_of_point(first.w, mass.w, impulse.w, total.w, substep));
}

// The friction rows: impulses stay inside an ellipsoid, with the force limit as its radius along the tangents and the
// torque limit along the twist. A body that spins fast has little friction left against sliding. The surface is Howe
// and Cutkosky's approximation (1996) of what points of friction spread over the face would do.
struct FrictionTarget {
    vec3 radii;         // N s along the frame's x and y, N m s about its z
    vec3 inverse_radii; // 0 where the limit is too small to hold anything
    vec3 sliding_mass;
};

const float k_least_friction = 1.0e-20f; // N s, and N m s: their inverses would leave the range of a float
const float k_most_radii = 1.0e15f;      // that an impulse may lie outside its limit: its square is still a float

// A manifold that slides takes masses in the ratio of the squared limits, and none above its own. Then what is left on
// the rim points against the motion, as the ellipsoid's normal does. With the rows' own masses a box lost 8 % of its
// friction on a slope of 35 degrees, and drifted to the side.
inline FrictionTarget make_friction_target(ManifoldRows rows, vec4 normal_impulse)
{
    precise vec4 moments = normal_impulse * rows.lever;
    precise float force = rows.friction * sum4(normal_impulse);
    precise float torque = rows.friction * sum4(moments);
    float inverse_force = choose(force > k_least_friction, reciprocal(force), 0.0f);
    float inverse_torque = choose(torque > k_least_friction, reciprocal(torque), 0.0f);
    float force_radius = choose(inverse_force > 0.0f, force, 0.0f);
    float torque_radius = choose(inverse_torque > 0.0f, torque, 0.0f);
    precise float lever = torque_radius * inverse_force;
    precise float square_lever = lever * lever;
    vec3 mass = rows.friction_mass;
    float smaller = min(mass.x, mass.y);
    smaller = choose(square_lever > 0.0f, min(smaller, mass.z * reciprocal(square_lever)), smaller);
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
    Touch touch;
    float old_share; // 1 where the impulses that a pass starts from are part of the step's sum already
};

// A body pair and its manifold in the midst of a pass.
struct ManifoldState {
    VelocityPair velocities;
    ManifoldImpulses impulses;
    bool is_hit;
};

// ---- normal rows ----

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

inline vec4 faster_than(vec4 velocity, float speed)
{
    return vec4(max(velocity.x - speed, 0.0f), max(velocity.y - speed, 0.0f), max(velocity.z - speed, 0.0f),
                max(velocity.w - speed, 0.0f));
}

struct NormalSweep {
    vec4 velocity; // J V, but for what each row's own impulse has changed last
    vec4 impulse;
};

// The impulses of light bodies that stop a heavy one grow from sub-step to sub-step as those of a spring do, and fall as
// slowly: they would throw it back as fast as it came. So where it leaves faster than it is pushed they fall as many
// times faster as it is heavier. In a pass no more than a part of an impulse goes: a light body between two others would be
// shot out where one of them lets go of all and the other of little. solver.md, Heavy on light.
const float k_most_let_go = 0.125f;

inline NormalTarget let_go_of_thrown(NormalTarget target, NormalSweep sweep)
{
    if (!any_lane(target.let_go > 0.0f)) return target;
    vec4 thrown = faster_than(sweep.velocity, target.push_speed);
    precise vec4 wanted = thrown * target.mass * target.let_go;
    precise vec4 less = target.offset - min4(wanted, sweep.impulse * k_most_let_go);
    target.offset = choose(target.let_go > 0.0f, less, target.offset);
    return target;
}

// The normal rows one after the other (equation 3.14, accumulated and clamped), each with what the ones before have
// done to its velocity.
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

inline uint sweeps_at(vec4 velocity)
{
    vec4 v = velocity;
    float fastest = max(max(abs(v.x), abs(v.y)), max(abs(v.z), abs(v.w)));
    return choose(fastest > k_fast, k_sweeps_of_fast, k_sweeps);
}

inline NormalSweep solve_normals(NormalSweep sweep, ManifoldRows rows, NormalTarget target)
{
    uint sweeps = sweeps_at(sweep.velocity);
    for (uint i = 0u; any_lane(i < sweeps); i += 1u) {
        NormalSweep next = sweep_normals(sweep, rows, target);
        if (all_lanes(i < sweeps))
            sweep = next;
        else
            sweep = choose_active(i < sweeps, next, sweep);
    }
    return sweep;
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
    bool sticks = dot3(on_sphere, on_sphere) <= 1.0f;
    vec3 sticking = multiply3(on_sphere, target.radii);
    if (all_lanes(sticks)) return sticking;

    precise vec3 sliding = impulse - target.sliding_mass * velocity;
    on_sphere = limit_each(multiply3(sliding, target.inverse_radii), k_most_radii);
    float square = dot3(on_sphere, on_sphere);
    on_sphere = choose(square > 1.0f, scale3(on_sphere, inverse_sqrt(square)), on_sphere);
    return choose_active(!sticks, multiply3(on_sphere, target.radii), sticking);
}

// ---- passes ----

inline bool is_finite_pair(VelocityPair v)
{
    precise float sum = (size3(v.a.linear) + size3(v.a.angular)) + (size3(v.b.linear) + size3(v.b.angular));
    return is_finite(sum);
}

// Friction comes before the normal rows, as keeping bodies apart matters more and the last row wins. The slip that these impulses
// act with is the caller's to note: a copy of it in the target made the CPU copy all of that.
inline ManifoldState solve_manifold(ManifoldState s, ManifoldRows rows, PassTarget target)
{
    ManifoldImpulses old = s.impulses;
    SpatialVector velocity = relative_velocity(s.velocities, rows.meeting.frame, target.touch);
    vec3 sliding = friction_velocities(velocity);
    vec3 friction = solve_friction_rows(old.friction, rows.friction_mass, sliding, target.friction);
    precise vec3 friction_change = friction - old.friction;

    NormalSweep sweep;
    sweep.velocity = normal_velocities(after_friction(velocity, rows, friction_change), rows);
    sweep.impulse = old.normal;
    s.is_hit = false;
    if (any_lane(rows.restitution > 0.0f))
        s.is_hit = is_any_hit(sweep.velocity, rows.normal_mass, target.normal.hit_speed, sum4(sweep.impulse));
    vec4 normal = solve_normals(sweep, rows, let_go_of_thrown(target.normal, sweep)).impulse;
    precise vec4 normal_change = normal - old.normal;
    precise vec4 total = old.total + (normal - old.normal * target.old_share);

    SpatialVector change = whole_impulse(rows, normal_change, friction_change);
    s.velocities = apply_impulse(s.velocities, rows.meeting, target.touch.arms, change, target.touch.moment);
    s.impulses.normal = normal;
    s.impulses.total = total;
    s.impulses.friction = friction;
    return s;
}

// The accumulated impulses again, to start from.
inline VelocityPair warm_start_manifold(VelocityPair v, ManifoldRows rows, ManifoldImpulses impulses)
{
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    SpatialVector whole = whole_impulse(rows, impulses.normal, impulses.friction);
    return apply_impulse(v, rows.meeting, rows.meeting.arms, whole, none);
}
