// SPDX-License-Identifier: MIT
// A hit: bodies that bounce, and close faster than the threshold. It is an event and no load: what it changes is not
// what the next sub-step should start from. It is solved to the end at once, and each point that is hit leaves with e
// times the speed that it came with; a chain of bodies passes it on from sub-step to sub-step.
// Needs resolution/contact.shared.glsl.

// The rows where the arms lead. A hit needs them: with others it would not keep the energy.
inline ManifoldRows move_rows(ManifoldRows rows, Arms arms)
{
    rows.meeting.arms = arms;
    NormalResponse r = respond_to_normals(rows.meeting);
    vec4 mass = rows.normal_mass; // 0 where there is no point
    rows.normal_mass = vec4(mass.x > 0.0f ? point_mass(r, rows.x.x, rows.y.x) : 0.0f,
                            mass.y > 0.0f ? point_mass(r, rows.x.y, rows.y.y) : 0.0f,
                            mass.z > 0.0f ? point_mass(r, rows.x.z, rows.y.z) : 0.0f,
                            mass.w > 0.0f ? point_mass(r, rows.x.w, rows.y.w) : 0.0f);
    rows.friction_mass = friction_masses(rows.meeting);
    return couple_rows(rows, r);
}

// `hits`: the constraint's.
inline bool has_been_hit(vec4 hits) { return sum4(hits) > 0.0f; }

// m/s: what contacts change about a loaded body in a sub-step, but for hits. With 8 sub-steps on Earth a body's own weight
// at rest is 0.0204.
const float k_loaded = 0.02f;

inline bool is_loaded(BodyVelocity velocity, BodyHits hits)
{
    return velocity.inverse_mass > 0.0f && dot3(hits.load, hits.load) > k_loaded * k_loaded;
}

// A contact is hit as often in a step as its bodies meet, as the edges of a box do that lands a little tilted, or a ball
// between two walls. But not where there is a load: a light body that a heavy one presses against another is thrown to
// and fro within a step by what its contacts change. Each throw would be a hit, none of which changes the load, and that
// drove the heavy one on.
inline bool can_be_hit_again(ManifoldState before, BodyHits hits_a, BodyHits hits_b)
{
    precise vec4 carried = before.impulses.normal + before.impulses.total;
    return !(sum4(carried) > 0.0f) && !is_loaded(before.velocities.a, hits_a) && !is_loaded(before.velocities.b, hits_b);
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

inline float time_of_bounce(float velocity, float mass, float separation, float inv_h, Parameters p)
{
    precise float gap = separation * inv_h;
    precise float time = max(gap, velocity) * reciprocal(-velocity * inv_h);
    return bounces(velocity, mass, max(gap, 0.0f), p) ? time : k_never;
}

// The velocity that a point is to have at the end of the sub-step, at least. `velocity` is the one there without the hit,
// and `gained` what the bodies gain of it by falling after the hit: v' = -e (v - gained) + gained.
inline float leaving_velocity(float velocity, float mass, float closing, float restitution, float gained, Parameters p)
{
    precise float leaving = max(0.0f, gained - restitution * (velocity - gained));
    return bounces(velocity, mass, closing, p) ? leaving : -closing;
}

// When the first point that bounces touches; 0 if none does.
inline float time_of_hit(vec4 velocity, vec4 mass, vec4 separations, float inv_h, Parameters p)
{
    float first = min(min(time_of_bounce(velocity.x, mass.x, separations.x, inv_h, p),
                          time_of_bounce(velocity.y, mass.y, separations.y, inv_h, p)),
                      min(time_of_bounce(velocity.z, mass.z, separations.z, inv_h, p),
                          time_of_bounce(velocity.w, mass.w, separations.w, inv_h, p)));
    return first < k_never ? first : 0.0f;
}

// `v`: the velocities before the pass. `falling`: m/s², the falling_acceleration of B less that of A.
inline Hit solve_hit(VelocityPair v, ManifoldRows rows, Slip slip, vec4 separations, vec3 falling, float inv_h,
                     Parameters p)
{
    vec4 closing = closing_speeds(separations, inv_h);
    Meeting m = rows.meeting;
    vec4 approaching = normal_velocities(relative_velocity(v, m.frame, touch_at(slipped_arms(m.arms, slip))), rows);
    float time = time_of_hit(approaching, rows.normal_mass, separations, inv_h, p);
    precise vec3 apart = slip.apart + (v.b.linear - v.a.linear) * time;
    slip.apart = apart;
    rows = move_rows(rows, slipped_arms(m.arms, slip));
    m = rows.meeting;

    SpatialVector motion = relative_velocity(v, m.frame, touch_at(m.arms));
    NormalSweep sweep;
    sweep.velocity = normal_velocities(motion, rows);
    sweep.impulse = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    vec4 velocity = sweep.velocity;
    vec4 mass = rows.normal_mass;
    float e = rows.restitution;
    precise float gained = dot3(falling, m.frame.z) * (reciprocal(inv_h) - time);
    vec4 leaving = vec4(leaving_velocity(velocity.x, mass.x, closing.x, e, gained, p),
                        leaving_velocity(velocity.y, mass.y, closing.y, e, gained, p),
                        leaving_velocity(velocity.z, mass.z, closing.z, e, gained, p),
                        leaving_velocity(velocity.w, mass.w, closing.w, e, gained, p));
    precise vec4 offset = mass * leaving;
    NormalTarget rigid;
    rigid.mass = mass;
    rigid.offset = offset;
    rigid.lower = sweep.impulse;
    rigid.hit_speed = closing; // not looked at
    for (uint i = 0u; i < k_sweeps_of_fast; i += 1u)
        sweep = sweep_normals(sweep, rows, rigid);

    // Then friction, within the limit that the hit itself gives.
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    vec4 no_points = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    v = apply_impulse(v, m, m.arms, whole_impulse(rows, sweep.impulse, none), none);
    vec3 sliding = friction_velocities(relative_velocity(v, m.frame, touch_at(m.arms)));
    vec3 friction = solve_friction_rows(none, rows.friction_mass, sliding, make_friction_target(rows, sweep.impulse));
    Hit hit;
    hit.velocities = apply_impulse(v, m, m.arms, whole_impulse(rows, no_points, friction), none);
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
