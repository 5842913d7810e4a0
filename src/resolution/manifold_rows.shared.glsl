// SPDX-License-Identifier: MIT
// The rows of a manifold: a normal row for each point, two friction rows, and one against twisting about the normal.
//
// The rows of the thesis meet two bodies at up to four points. These meet them at one place, the middle of the points,
// and in one frame, with the normal as its z. All that they see of the bodies' velocities V are then six numbers, the
// relative linear and angular velocity; all that they do are six more, an impulse and a moment; and what the rows do to
// each other is known before the velocities are. Point i, at (x, y) from the middle, has the Jacobian (equation 3.6)
//   J_i V = linear.z + y angular.x - x angular.y
// Points lie in the frame's plane: how far above it or below one lies is of second order.
//
// Symbols: v, w linear and angular velocity; c the middle of the points from a body's centre; n normal from A to B;
// K = J M^-1 J^T (equation 3.15 without the inversion). A vec4 holds a number for each of the four points; a point that
// is not there has mass 0, and so no impulse.
// Needs resolution/contact_frame.shared.glsl and body.shared.glsl.

// Linear and angular part together (Featherstone, "Rigid Body Dynamics Algorithms", 2008) along the axes of the
// contact's frame: of B's velocity as seen from A, or of an impulse on B and its moment.
struct SpatialVector {
    vec3 linear;
    vec3 angular;
};

// m, world axes: from each body's centre to where both meet.
struct Arms {
    vec3 a;
    vec3 b;
};

struct VelocityPair {
    BodyVelocity a;
    BodyVelocity b;
};

// Where and in what directions two bodies meet, and how they yield.
struct Meeting {
    Axes frame;
    Arms arms; // to the middle of the points
    BodyInertia inertia_a;
    BodyInertia inertia_b;
    float inverse_mass_a; // 1/kg
    float inverse_mass_b;
    float inverse_masses; // the sum, of the shares of hubs
};

// v_b - v_a where the bodies meet. `linear`: that of their centres.
inline vec3 velocity_between(vec3 linear, vec3 w_a, vec3 w_b, Arms arms)
{
    precise vec3 velocity = linear + (cross3(w_b, arms.b) - cross3(w_a, arms.a));
    return velocity;
}

const uint k_traits_of_b = 4u; // bits that B's traits are shifted by in a constraint

// Whether contacts push a body in this step; in a constraint the traits of B are shifted.
inline bool is_pushed(uint traits) { return (traits & (k_trait_movable | k_trait_asleep)) == k_trait_movable; }

inline bool is_against_static(uint traits)
{
    return (traits & (traits >> k_traits_of_b) & k_trait_movable) == 0u;
}

// ---- K ----

// How the relative velocity changes by an impulse on B at the middle, and a moment; A gets the opposite. World axes.
inline SpatialVector respond(Meeting m, vec3 impulse, vec3 moment)
{
    precise vec3 torque_a = cross3(m.arms.a, impulse) + moment;
    precise vec3 torque_b = cross3(m.arms.b, impulse) + moment;
    vec3 w_a = multiply_inertia(m.inertia_a, vec3(-torque_a.x, -torque_a.y, -torque_a.z));
    vec3 w_b = multiply_inertia(m.inertia_b, torque_b);
    vec3 linear = velocity_between(scale3(impulse, m.inverse_masses), w_a, w_b, m.arms);
    precise vec3 angular = w_b - w_a;
    SpatialVector response;
    response.linear = to_local(m.frame, linear);
    response.angular = to_local(m.frame, angular);
    return response;
}

// K of what the normal rows act by: a push along the normal, and moments about the frame's x and y (tilts).
struct NormalResponse {
    SpatialVector push;
    SpatialVector tilt_x;
    SpatialVector tilt_y;
};

inline NormalResponse respond_to_normals(Meeting m)
{
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    NormalResponse r;
    r.push = respond(m, m.frame.z, none);
    r.tilt_x = respond(m, none, m.frame.x);
    r.tilt_y = respond(m, none, m.frame.y);
    return r;
}

// What a unit of impulse at the point (x, y) does to linear.z, angular.x and angular.y.
inline vec3 respond_to_point(NormalResponse r, float x, float y)
{
    precise vec3 response =
        vec3(r.push.linear.z, r.push.angular.x, r.push.angular.y) +
        (vec3(r.tilt_x.linear.z, r.tilt_x.angular.x, r.tilt_x.angular.y) * y -
         vec3(r.tilt_y.linear.z, r.tilt_y.angular.x, r.tilt_y.angular.y) * x);
    return response;
}

// J V of the point (x, y), of linear.z, angular.x and angular.y.
inline float point_velocity(vec3 motion, float x, float y)
{
    precise float velocity = motion.x + (y * motion.y - x * motion.z);
    return velocity;
}

// 1 / K: an effective mass (equation 3.15). Without a K, as of a body that nothing turns, there is nothing to solve.
inline float effective_mass(float k) { return choose(k > 0.0f, reciprocal(k), 0.0f); }

inline float point_mass(NormalResponse r, float x, float y)
{
    return effective_mass(point_velocity(respond_to_point(r, x, y), x, y));
}

// Along the frame's x and y, and about its z.
inline vec3 friction_masses(Meeting m)
{
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    return vec3(effective_mass(respond(m, m.frame.x, none).linear.x),
                effective_mass(respond(m, m.frame.y, none).linear.y),
                effective_mass(respond(m, none, m.frame.z).angular.z));
}

// ---- the rows ----

// All that stays the same in the passes of a step.
struct ManifoldRows {
    Meeting meeting;
    vec4 x; // m, each point from the middle, in the frame
    vec4 y;
    vec4 lever; // m, its distance from there
    vec4 normal_mass;   // kg
    vec3 friction_mass; // kg, kg, kg m^2
    // K between the rows.
    vec3 coupling_0; // of point 0 with points 1, 2, 3
    vec3 coupling_1; // of point 1 with points 2 and 3; of point 2 with point 3
    vec3 friction_push; // what friction does to linear.z, angular.x and angular.y
    vec3 friction_tilt_x;
    vec3 friction_tilt_y;
    float friction;
    float restitution;
};

inline ManifoldRows couple_rows(ManifoldRows rows, NormalResponse r)
{
    vec4 x = rows.x;
    vec4 y = rows.y;
    vec3 response_0 = respond_to_point(r, x.x, y.x);
    vec3 response_1 = respond_to_point(r, x.y, y.y);
    vec3 response_2 = respond_to_point(r, x.z, y.z);
    rows.coupling_0 = vec3(point_velocity(response_0, x.y, y.y), point_velocity(response_0, x.z, y.z),
                           point_velocity(response_0, x.w, y.w));
    rows.coupling_1 = vec3(point_velocity(response_1, x.z, y.z), point_velocity(response_1, x.w, y.w),
                           point_velocity(response_2, x.w, y.w));
    rows.friction_push = vec3(r.push.linear.x, r.push.linear.y, r.push.angular.z);
    rows.friction_tilt_x = vec3(r.tilt_x.linear.x, r.tilt_x.linear.y, r.tilt_x.angular.z);
    rows.friction_tilt_y = vec3(r.tilt_y.linear.x, r.tilt_y.linear.y, r.tilt_y.angular.z);
    return rows;
}

// Of a share of a hub. `its_traits`: the constraint's, of this body.
inline BodyInertia share_inertia(BodyInertia m, float hub_share, uint its_traits)
{
    if (any_lane((its_traits & k_trait_hub) != 0u)) {
        float shares = choose_active((its_traits & k_trait_hub) != 0u, reciprocal(hub_share), 1.0f);
        precise vec3 diagonal = vec3(m.xx, m.yy, m.zz) * shares;
        precise vec3 rest = vec3(m.xy, m.xz, m.yz) * shares;
        m.xx = diagonal.x;
        m.yy = diagonal.y;
        m.zz = diagonal.z;
        m.xy = rest.x;
        m.xz = rest.y;
        m.yz = rest.z;
    }
    return m;
}

inline float share_inverse_mass(float inverse_mass, float hub_share, uint its_traits)
{
    float share = inverse_mass;
    if (any_lane((its_traits & k_trait_hub) != 0u)) {
        precise float of_share = inverse_mass * reciprocal(hub_share);
        share = choose_active((its_traits & k_trait_hub) != 0u, of_share, inverse_mass);
    }
    return share;
}

inline Meeting make_meeting(ContactConstraint c, BodyInertia inertia_a, BodyInertia inertia_b)
{
    Meeting m;
    m.frame = contact_frame(c.normal);
    m.arms.a = c.centre_a;
    m.arms.b = c.centre_b;
    m.inertia_a = share_inertia(inertia_a, c.hub_share, c.traits);
    m.inertia_b = share_inertia(inertia_b, c.hub_share, c.traits >> k_traits_of_b);
    m.inverse_mass_a = c.inverse_mass_a;
    m.inverse_mass_b = c.inverse_mass_b;
    precise float inverse_masses = share_inverse_mass(c.inverse_mass_a, c.hub_share, c.traits) +
                                   share_inverse_mass(c.inverse_mass_b, c.hub_share, c.traits >> k_traits_of_b);
    m.inverse_masses = inverse_masses;
    return m;
}

inline ManifoldRows make_rows(ContactConstraint c, BodyInertia inertia_a, BodyInertia inertia_b)
{
    ManifoldRows rows;
    rows.meeting = make_meeting(c, inertia_a, inertia_b);
    rows.x = c.x;
    rows.y = c.y;
    rows.lever = c.lever;
    rows.normal_mass = c.normal_mass;
    rows.friction_mass = c.friction_mass;
    rows.friction = c.friction;
    rows.restitution = c.restitution;
    return couple_rows(rows, respond_to_normals(rows.meeting));
}

// ---- velocities in, impulses out ----

inline vec4 normal_velocities(SpatialVector motion, ManifoldRows rows)
{
    precise vec4 velocity = motion.linear.z + (rows.y * motion.angular.x - rows.x * motion.angular.y);
    return velocity;
}

inline vec3 friction_velocities(SpatialVector motion)
{
    return vec3(motion.linear.x, motion.linear.y, motion.angular.z);
}

// What the normal rows see of a motion once the friction rows have changed by `impulse`.
inline SpatialVector after_friction(SpatialVector motion, ManifoldRows rows, vec3 impulse)
{
    precise float linear = motion.linear.z + dot3(rows.friction_push, impulse);
    precise float tilt_x = motion.angular.x + dot3(rows.friction_tilt_x, impulse);
    precise float tilt_y = motion.angular.y + dot3(rows.friction_tilt_y, impulse);
    motion.linear.z = linear;
    motion.angular.x = tilt_x;
    motion.angular.y = tilt_y;
    return motion;
}

// The rows' impulses together: J^T lambda.
inline SpatialVector whole_impulse(ManifoldRows rows, vec4 normal, vec3 friction)
{
    precise vec4 about_x = rows.y * normal;
    precise vec4 about_y = rows.x * normal;
    SpatialVector whole;
    whole.linear = vec3(friction.x, friction.y, sum4(normal));
    whole.angular = vec3(sum4(about_x), -sum4(about_y), friction.z);
    return whole;
}

// M^-1 J^T lambda (equation 3.13), where the arms lead. `on_top`: N m s in world axes on A, the opposite on B.
inline VelocityPair apply_impulse(VelocityPair v, Meeting m, Arms arms, SpatialVector whole, vec3 on_top)
{
    vec3 impulse = to_world(m.frame, whole.linear);
    vec3 moment = to_world(m.frame, whole.angular);
    precise vec3 torque_a = cross3(arms.a, impulse) + (moment + on_top);
    precise vec3 torque_b = cross3(arms.b, impulse) + (moment - on_top);
    precise vec3 linear_a = v.a.linear - impulse * m.inverse_mass_a;
    precise vec3 linear_b = v.b.linear + impulse * m.inverse_mass_b;
    precise vec3 angular_a = v.a.angular - multiply_inertia(m.inertia_a, torque_a);
    precise vec3 angular_b = v.b.angular + multiply_inertia(m.inertia_b, torque_b);
    v.a.linear = linear_a;
    v.b.linear = linear_b;
    v.a.angular = angular_a;
    v.b.angular = angular_b;
    return v;
}
