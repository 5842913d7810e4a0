// SPDX-License-Identifier: MIT
// Sleep: who rests, and what keeps an island awake. docs/solver.md has the rule. Needs broad_phase/aabb.shared.glsl.

inline bool is_asleep(BodyPose pose) { return (pose.flags & k_body_asleep) != 0u; }

inline bool is_still(BodyVelocity velocity)
{
    return velocity.linear.x == 0.0f && velocity.linear.y == 0.0f && velocity.linear.z == 0.0f &&
           velocity.angular.x == 0.0f && velocity.angular.y == 0.0f && velocity.angular.z == 0.0f;
}

// Whether a body keeps awake the island that it is part of; where contacts cannot push it, those that it touches. What
// is frozen will not move.
inline bool is_restless(BodyPose pose, BodyVelocity velocity, BodyShape shape, Parameters p)
{
    if (p.rest_steps == 0u || (pose.flags & k_body_disturbed) != 0u) return true;
    if (!is_movable(shape)) return is_mover(shape) && !is_still(velocity);
    return (pose.flags & k_body_frozen) == 0u && (pose.flags >> k_rest_shift) < p.rest_steps;
}

// Whether it keeps the world awake. Where nothing does, who sleeps is who slept.
inline bool is_awake(BodyPose pose, BodyVelocity velocity, BodyShape shape, Parameters p)
{
    return is_movable(shape) ? !is_asleep(pose) : is_restless(pose, velocity, shape, p);
}

// Whether a body is where it was when the last step looked for contacts: it sleeps, or it stands where it is put.
inline bool is_left_alone(BodyPose pose, BodyVelocity velocity, BodyShape shape)
{
    if (is_movable(shape)) return is_asleep(pose);
    return (pose.flags & k_body_disturbed) == 0u && (!is_mover(shape) || is_still(velocity));
}

// Whether two bodies are, of which one sleeps.
inline bool sleep_on(BodyPose pose_a, BodyVelocity velocity_a, BodyShape shape_a, BodyPose pose_b, BodyVelocity velocity_b,
                     BodyShape shape_b)
{
    return (is_asleep(pose_a) || is_asleep(pose_b)) && is_left_alone(pose_a, velocity_a, shape_a) &&
           is_left_alone(pose_b, velocity_b, shape_b);
}

// Whether it was so in the step before that, too.
inline bool is_settled(BodyPose pose) { return (pose.flags & (k_body_settled | k_body_disturbed)) == k_body_settled; }

// Whether a pair has the contact that it had in the last two steps.
inline bool are_settled(BodyPose pose_a, BodyPose pose_b)
{
    return is_settled(pose_a) && is_settled(pose_b) && (is_asleep(pose_a) || is_asleep(pose_b));
}

// Whether it sleeps as a part of a large island, and nothing has happened to it.
inline bool is_quiet_part(BodyPose pose)
{
    return (pose.flags & (k_body_asleep | k_body_in_part | k_body_disturbed)) == (k_body_asleep | k_body_in_part);
}

// Of a body that is to sleep in this step, maybe as a part of a large island, or to be awake.
inline uint flags_in_step(BodyPose pose, BodyShape shape, bool asleep, bool in_part, Parameters p)
{
    bool stands = !is_mover(shape) && (pose.flags & k_body_disturbed) == 0u;
    bool settled = p.rest_steps > 0u && (stands || (asleep && is_asleep(pose)));
    uint flags = pose.flags & ~(k_body_asleep | k_body_settled | k_body_in_part);
    return flags | (asleep ? k_body_asleep : 0u) | (settled ? k_body_settled : 0u) | (in_part ? k_body_in_part : 0u);
}

// Of a body that has to begin its rest anew.
inline uint without_rest(uint flags) { return flags & ((1u << k_rest_shift) - 1u); }
inline uint wake_flags(uint flags) { return without_rest(flags) & ~(k_body_asleep | k_body_settled | k_body_in_part); }

// From where a body's way is measured.
inline BodyRest begin_rest(BodyPose pose)
{
    BodyRest rest;
    rest.position = pose.position;
    rest.calm = 0u;
    rest.rotation = pose.rotation;
    return rest;
}

// The same before a step, where `kept` is what is kept of it: nothing yet of a body that has not rested, or of the one that
// had its slot before.
inline BodyRest rest_so_far(BodyPose pose, BodyRest kept)
{
    if ((pose.flags >> k_rest_shift) == 0u) return begin_rest(pose);
    return kept;
}

// Whether a body has gone too far from where its rest began, or of late, or moved too fast in this step to be said to rest.
inline bool ends_rest(BodyPose pose, BodyDelta delta, BodyRest rest, BodyShape shape, Parameters p)
{
    precise vec3 movement = pose.position - rest.position;
    vec4 back = vec4(-rest.rotation.x, -rest.rotation.y, -rest.rotation.z, rest.rotation.w);
    float way = way_of(movement, multiply_quaternions(pose.rotation, back), shape);
    return !(way <= p.rest_distance && way_of(delta.position, delta.rotation, shape) <= p.rest_way);
}

// The flags after another step of rest. What has rested for long enough counts on from there, to measure its way anew
// after as long again.
inline uint count_rest(uint flags, Parameters p)
{
    uint steps = (flags >> k_rest_shift) + 1u;
    if (steps >= 2u * p.rest_steps) steps = p.rest_steps;
    return without_rest(flags) | (steps << k_rest_shift);
}

// Whether a body's way is measured from here on: its rest has ended, or lasted long enough once more.
inline bool measures_anew(uint flags, Parameters p)
{
    uint steps = flags >> k_rest_shift;
    return steps == 0u || steps == p.rest_steps;
}

// A body's rest after a step.
struct NextRest {
    BodyRest rest; // from where its way is measured on
    uint flags;    // of its pose, with how long it has rested
};

// `moved`: where the step has brought it. `touched`: something restless touches it.
inline NextRest next_rest(BodyPose pose, BodyPose moved, BodyDelta delta, BodyRest kept, bool touched, BodyShape shape, Parameters p)
{
    NextRest next;
    next.rest = rest_so_far(pose, kept);
    uint calm = touched ? 0u : min(next.rest.calm + 1u, p.rest_steps);
    next.flags = wake_flags(moved.flags);
    if (!ends_rest(moved, delta, next.rest, shape, p)) next.flags = count_rest(moved.flags, p);
    if (measures_anew(next.flags, p)) next.rest = begin_rest(moved);
    next.rest.calm = calm;
    return next;
}

// Whether nothing restless has touched a body for as long as it has to rest, if nothing does in this step.
inline bool is_calm(BodyRest rest, Parameters p) { return rest.calm + 1u >= p.rest_steps; }

// Of what falls asleep: for as long as it has to rest, or what is kept of a large island. A sleeper that is out of balance has been calm
// for no steps, and so is awake in the next one.
inline BodyRest with_calm(BodyRest rest, uint steps)
{
    rest.calm = steps;
    return rest;
}

// Whether a contact is the last step's: a body of it sleeps, and the other does, or cannot be pushed.
inline bool sleeps_through(BodyPose pose_a, BodyShape shape_a, BodyPose pose_b, BodyShape shape_b)
{
    bool a_stays = is_asleep(pose_a) || !is_movable(shape_a);
    bool b_stays = is_asleep(pose_b) || !is_movable(shape_b);
    return a_stays && b_stays && (is_asleep(pose_a) || is_asleep(pose_b));
}
