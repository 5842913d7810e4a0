// SPDX-License-Identifier: MIT
// What the resolution does to one body: inertia, forces, gyroscopic torque, positions.

// Whether launches treat a body, as no work group does and its island is awake.
inline bool is_launched(BodyInertia inertia)
{
    return (inertia.traits & k_trait_grouped) == 0u && inertia.substeps != 0u;
}

// Of these, the ones that move, but for hubs, whose keepers integrate them.
inline bool is_in_launched_bodies(BodyInertia inertia)
{
    return is_launched(inertia) && (inertia.traits & (k_trait_moves | k_trait_hub)) == k_trait_moves;
}

// R diag(1/I) R^T, with R's columns the body's axes.
inline BodyInertia world_inertia(vec4 rotation, vec3 inverse_inertia, uint traits, uint substeps)
{
    Axes r = rotation_axes(rotation);
    vec3 d = inverse_inertia;
    precise float xx = r.x.x * r.x.x * d.x + r.y.x * r.y.x * d.y + r.z.x * r.z.x * d.z;
    precise float yy = r.x.y * r.x.y * d.x + r.y.y * r.y.y * d.y + r.z.y * r.z.y * d.z;
    precise float zz = r.x.z * r.x.z * d.x + r.y.z * r.y.z * d.y + r.z.z * r.z.z * d.z;
    precise float xy = r.x.x * r.x.y * d.x + r.y.x * r.y.y * d.y + r.z.x * r.z.y * d.z;
    precise float xz = r.x.x * r.x.z * d.x + r.y.x * r.y.z * d.y + r.z.x * r.z.z * d.z;
    precise float yz = r.x.y * r.x.z * d.x + r.y.y * r.y.z * d.y + r.z.y * r.z.z * d.z;
    float on = (traits & k_trait_movable) != 0u ? 1.0f : 0.0f;
    BodyInertia m;
    m.xx = on * xx;
    m.yy = on * yy;
    m.zz = on * zz;
    m.xy = on * xy;
    m.xz = on * xz;
    m.yz = on * yz;
    m.traits = traits;
    m.substeps = substeps;
    return m;
}

// Of a body that sleeps. Contacts give way to what presses on them as if it were awake, so that nothing changes as it falls asleep;
// only it stays where it is, and has no sub-steps.
inline BodyInertia inertia_asleep(vec4 rotation, vec3 inverse_inertia, uint traits)
{
    return world_inertia(rotation, inverse_inertia, (traits & ~k_trait_moves) | k_trait_asleep, 0u);
}

inline vec3 multiply_inertia(BodyInertia m, vec3 v)
{
    precise float x = m.xx * v.x + m.xy * v.y + m.xz * v.z;
    precise float y = m.xy * v.x + m.yy * v.y + m.yz * v.z;
    precise float z = m.xz * v.x + m.yz * v.y + m.zz * v.z;
    return vec3(x, y, z);
}

inline BodyDelta no_delta()
{
    BodyDelta d;
    d.position = vec3(0.0f, 0.0f, 0.0f);
    d.reserved = 0.0f;
    d.rotation = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    return d;
}

// v shortened to at most `limit`.
inline vec3 limit_length(vec3 v, float limit)
{
    float square = dot3(v, v);
    precise float square_limit = limit * limit;
    vec3 limited = v;
    if (any_lane(square > square_limit)) {
        precise float scale = limit * inverse_sqrt(square);
        limited = choose_active(square > square_limit, scale3(v, scale), v);
    }
    return limited;
}

// Angular velocity after h under no torque, in body axes: Euler's equation I w' = -w x I w by the implicit midpoint
// rule, which keeps the kinetic energy and the length of the angular momentum. Four rounds of fixed-point iteration
// reach float precision while |w| h is below a quarter.
inline vec3 turn_freely(vec3 w, vec3 inverse_inertia, float h)
{
    vec3 inertia = vec3(reciprocal(inverse_inertia.x), reciprocal(inverse_inertia.y), reciprocal(inverse_inertia.z));
    vec3 middle = w;
    for (uint i = 0u; any_lane(i < 4u); i += 1u) {
        vec3 torque = cross3(multiply3(inertia, middle), middle);
        precise vec3 change = multiply3(inverse_inertia, torque) * (0.5f * h);
        precise vec3 next = w + change;
        middle = next;
    }
    precise vec3 result = 2.0f * middle - w;
    return result;
}

// ---- warm start ----
//
// A sub-step starts from the impulses of the one before (thesis: accumulated and applied again). What they do to a body
// is the change of its velocity from before the last sub-step's contacts to now, so a body finds its share by itself:
// only the first sub-step of a step, whose impulses come from the last step, needs a pass over the contacts.

// As it is kept from one sub-step to the next: `warm` less the velocity with which contacts begin.
inline BodyWarmStart kept_warm_start(BodyWarmStart warm, BodyVelocity velocity)
{
    precise vec3 linear = warm.linear - velocity.linear;
    precise vec3 angular = warm.angular - velocity.angular;
    warm.linear = linear;
    warm.angular = angular;
    return warm;
}

// `kept`, with what the last sub-step's contacts have changed: its own velocity was taken off, and this is the one behind them.
inline BodyWarmStart gather_impulses(BodyWarmStart kept, BodyVelocity velocity)
{
    precise vec3 linear = kept.linear + velocity.linear;
    precise vec3 angular = kept.angular + velocity.angular;
    kept.linear = linear;
    kept.angular = angular;
    return kept;
}

inline BodyWarmStart no_warm_start()
{
    BodyWarmStart warm;
    warm.linear = vec3(0.0f, 0.0f, 0.0f);
    warm.reserved_1 = 0.0f;
    warm.angular = vec3(0.0f, 0.0f, 0.0f);
    warm.reserved_2 = 0.0f;
    return warm;
}

// What changes the velocity so, a hit or a limit, is no load to start from. In the order of these sums nothing is left of it where
// contacts have changed nothing else.
inline BodyWarmStart leave_out(BodyWarmStart kept, BodyVelocity before, BodyVelocity after)
{
    precise vec3 linear = (kept.linear + before.linear) - after.linear;
    precise vec3 angular = (kept.angular + before.angular) - after.angular;
    kept.linear = linear;
    kept.angular = angular;
    return kept;
}

// ---- hits ----

// Where a body has them: behind the warm starts of all. Behind these are those of contacts, two in a record, as some kernels have
// no room for another buffer.
inline uint hits_place(uint body, uint body_count) { return body_count + body; }
inline uint contact_hits_place(uint index, uint body_count) { return 2u * body_count + index / 2u; }
inline bool are_first_hits(uint index) { return index % 2u == 0u; }

// At the start of a sub-step, with the warm start that it begins with.
inline BodyHits no_hits(BodyWarmStart warm)
{
    BodyHits hits;
    hits.shift = vec3(0.0f, 0.0f, 0.0f);
    hits.reserved_1 = 0.0f;
    hits.load = warm.linear;
    hits.reserved_2 = 0.0f;
    return hits;
}

// Of a body that is hit `time` into the sub-step, which will move it by its velocity after the hit; until then it has had the one
// before.
inline BodyHits take_hit(BodyHits hits, BodyVelocity before, BodyVelocity after, float time)
{
    precise vec3 shift = hits.shift + (before.linear - after.linear) * time;
    hits.shift = shift;
    return hits;
}

// Where the hits of the sub-step say that the body has been all along.
inline BodyDelta shifted(BodyDelta delta, vec3 shift)
{
    precise vec3 position = delta.position + shift;
    delta.position = position;
    return delta;
}

// ---- forces ----

// The implicit 1 / (1 + h c). Without damping it is 1, not a rounding less: a body in free flight keeps its speed.
inline float damping_factor(float damping, float h)
{
    precise float factor = reciprocal(1.0f + h * damping);
    return choose(damping > 0.0f, factor, 1.0f);
}

// m/s², by gravity and the caller's load.
inline vec3 acceleration_by_forces(BodyVelocity velocity, BodyProperties body, BodyLoad load, Parameters p)
{
    precise vec3 acceleration = p.gravity * body.gravity_scale + load.force * velocity.inverse_mass;
    return acceleration;
}

// A body falls freely as long as contacts change its velocity by less than this of what forces do. Not only by nothing at
// all: what brushes along a wall in its fall still falls.
const float k_falling_share = 0.125f;

// m/s², by forces, of a body that falls freely in this sub-step. 0 of one that contacts hold, or that does not move.
inline vec3 falling_acceleration(BodyVelocity velocity, BodyWarmStart kept, BodyProperties body, BodyInertia inertia,
                                 BodyLoad load, float h, Parameters p)
{
    vec3 by_forces = acceleration_by_forces(velocity, body, load, p);
    vec3 by_contacts = gather_impulses(kept, velocity).linear;
    precise float limit = k_falling_share * h;
    precise float square_limit = limit * limit * dot3(by_forces, by_forces);
    bool falls = (inertia.traits & k_trait_moves) != 0u && dot3(by_contacts, by_contacts) < square_limit;
    return choose(falls, by_forces, vec3(0.0f, 0.0f, 0.0f));
}

// ---- limits of speed ----

// After contacts. What they cannot push goes as fast as its caller says.
inline BodyVelocity limit_speeds(BodyVelocity velocity, Parameters p)
{
    bool pushed = velocity.inverse_mass > 0.0f;
    velocity.linear = choose(pushed, limit_length(velocity.linear, p.max_linear_speed), velocity.linear);
    velocity.angular = choose(pushed, limit_length(velocity.angular, p.max_angular_speed), velocity.angular);
    return velocity;
}

// ---- a sub-step ----

// Velocity after the sub-step's forces: gravity, the caller's load, damping, gyroscopic torque, the speed limits; then
// the warm start, as a whole. `rotation` is the present one.
inline BodyVelocity integrate_velocity(BodyVelocity velocity, BodyWarmStart warm, vec4 rotation, BodyProperties body,
                                       BodyInertia inertia, BodyLoad load, bool rigid, float h, Parameters p)
{
    precise vec3 linear = velocity.linear + acceleration_by_forces(velocity, body, load, p) * h;
    velocity.linear = linear; // of a kinematic body: gravity if its caller asked for it, nothing else
    if (any_lane(rigid)) {
        precise vec3 angular = velocity.angular + multiply_inertia(inertia, load.torque) * h;
        float linear_factor = damping_factor(body.linear_damping, h);
        float angular_factor = damping_factor(body.angular_damping, h);
        angular = limit_length(angular, p.max_angular_speed);
        vec3 d = body.inverse_inertia;
        if (any_lane(d.x != d.y || d.y != d.z)) {
            vec3 local = rotate_back(rotation, angular);
            precise float turn = 4.0f * length3(local) * h; // in quarters of a radian
            float whole = min(255.0f, turn); // in this order: of what is no number it is 255
            uint parts = choose_active(d.x != d.y || d.y != d.z, uint(whole) + 1u, 1u);
            precise float part = h * reciprocal(float(parts));
            for (uint i = 0u; any_lane(i < parts); i += 1u)
                local = choose_active(i < parts, turn_freely(local, d, part), local);
            angular = choose_active(d.x != d.y || d.y != d.z, rotate(rotation, local), angular);
        }
        precise vec3 started_linear = limit_length(scale3(linear, linear_factor), p.max_linear_speed) + warm.linear;
        precise vec3 started_angular = limit_length(scale3(angular, angular_factor), p.max_angular_speed) + warm.angular;
        velocity.linear = choose_active(rigid, started_linear, linear);
        velocity.angular = choose_active(rigid, started_angular, velocity.angular);
    }
    return velocity;
}

// Of a body whose velocity became non-finite: it stays where it is, and contacts find it as heavy as a static body.
inline BodyVelocity frozen_velocity()
{
    BodyVelocity velocity;
    velocity.linear = vec3(0.0f, 0.0f, 0.0f);
    velocity.inverse_mass = 0.0f;
    velocity.angular = vec3(0.0f, 0.0f, 0.0f);
    velocity.stamp = 0u;
    return velocity;
}

inline BodyVelocity stop(BodyVelocity velocity)
{
    velocity.linear = vec3(0.0f, 0.0f, 0.0f);
    velocity.angular = vec3(0.0f, 0.0f, 0.0f);
    return velocity;
}

// `shift`: BodyHits::shift. `falling`: falling_acceleration. What falls moves along its parabola, h v - h^2 a / 2 with the
// velocity that it has at the end; what contacts hold moves by h v, as they were solved for.
inline BodyDelta integrate_position(BodyDelta delta, vec3 shift, BodyVelocity velocity, vec3 falling, float h)
{
    precise float half_square = 0.5f * h * h;
    vec3 position = add_scaled(shifted(delta, shift).position, velocity.linear, h);
    delta.position = add_scaled(position, falling, -half_square);
    delta.rotation = integrate_rotation(delta.rotation, velocity.angular, h);
    return delta;
}

// The pose at the end of the step. The delta turns the world, so it comes after the rotation that the body had. Where
// it is now, it has come by itself.
inline BodyPose apply_delta(BodyPose pose, BodyDelta delta)
{
    precise vec3 position = pose.position + delta.position;
    pose.position = position;
    pose.rotation = normalise_quaternion(multiply_quaternions(delta.rotation, pose.rotation));
    pose.flags &= ~k_body_placed;
    return pose;
}

inline bool is_finite_motion(BodyPose pose, BodyVelocity velocity)
{
    return is_finite3(pose.position) && is_finite(pose.rotation.x) && is_finite(pose.rotation.y) &&
           is_finite(pose.rotation.z) && is_finite(pose.rotation.w) && is_finite3(velocity.linear) &&
           is_finite3(velocity.angular);
}

inline bool is_loaded(BodyLoad load)
{
    return load.force.x != 0.0f || load.force.y != 0.0f || load.force.z != 0.0f || load.torque.x != 0.0f ||
           load.torque.y != 0.0f || load.torque.z != 0.0f;
}

inline BodyLoad no_load()
{
    BodyLoad load;
    load.force = vec3(0.0f, 0.0f, 0.0f);
    load.disturbed = 0u;
    load.torque = vec3(0.0f, 0.0f, 0.0f);
    load.reserved_2 = 0.0f;
    return load;
}
