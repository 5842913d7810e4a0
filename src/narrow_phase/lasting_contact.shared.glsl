// SPDX-License-Identifier: MIT
// Contacts that last: what two bodies that have hardly moved on each other have of the last step's (docs/decisions/contacts-that-last.md).
// Needs narrow_phase/manifold.shared.glsl, narrow_phase/box_axes.shared.glsl, broad_phase/oriented_box.shared.glsl and
// finish/body_start.shared.glsl.

// How far a contact may have moved since its bodies were collided (m; see LastingAxis), as a part of how far ahead contacts are seen.
const float k_lasting_way = 1.0f / 32.0f;

// The last step's turns are known to a 256th of their largest component, and are taken for vectors: an error of up to this part of
// each, as long as it is below 1/64 rad.
const float k_turn_error = 1.0f / 64.0f;

// How a body moves in a step.
struct Movement {
    vec3 shift; // m, world
    vec3 turn;  // rad, world
};

inline Movement last_movement(BodyPose pose, BodyStart start)
{
    precise vec3 shift = pose.position - start.position;
    Movement movement;
    movement.shift = shift;
    movement.turn = unpack_turn(start.turn);
    return movement;
}

inline Movement next_movement(BodyVelocity velocity, Parameters p)
{
    Movement movement;
    movement.shift = scale3(velocity.linear, p.dt);
    movement.turn = scale3(velocity.angular, p.dt);
    return movement;
}

// Of a point of the body, `arm` from its centre.
inline vec3 movement_at(Movement movement, vec3 arm)
{
    precise vec3 shift = movement.shift + cross3(movement.turn, arm);
    return shift;
}

// A point where both bodies are, and how far any other may be from it (m).
struct MeetingPoint {
    vec3 arm_a; // m, from A's centre
    vec3 arm_b;
    float reach;
};

inline MeetingPoint meeting_point(vec3 anchor, vec3 offset, BodyShape a, BodyShape b)
{
    precise vec3 arm_b = anchor - offset;
    precise float reach = 2.0f * min(length3(a.half_extents), length3(b.half_extents));
    MeetingPoint point;
    point.arm_a = anchor;
    point.arm_b = arm_b;
    point.reach = reach;
    return point;
}

// What is not known of how a turn moves what is so far from the centre (m). Of a turn that is no small one that is all of it.
inline float turn_error(vec3 turn, float distance)
{
    float size = length3(turn);
    precise float error = choose(size < k_turn_error, k_turn_error, 1.0f) * size * distance;
    return error;
}

// How far the bodies move on each other at most, wherever they might touch, and what is not known of that.
inline float way_between(Movement a, Movement b, MeetingPoint point)
{
    precise vec3 apart = movement_at(b, point.arm_b) - movement_at(a, point.arm_a);
    precise vec3 turn = b.turn - a.turn;
    precise float distance_a = length3(point.arm_a) + point.reach;
    precise float distance_b = length3(point.arm_b) + point.reach;
    precise float errors = turn_error(a.turn, distance_a) + turn_error(b.turn, distance_b);
    precise float way = length3(apart) + length3(turn) * point.reach + errors;
    return way;
}

// Whether two bodies may have the contact of the last step, whatever their motion: the caller has left both alone, and neither is gone, a
// sensor, or a sphere. That meets others below its centre, wherever it rolls: where it met them once is behind it, and a push from
// there turns it on, faster and faster.
inline bool may_last(BodyStart start_a, BodyShape shape_a, BodyStart start_b, BodyShape shape_b)
{
    return start_a.turn != k_no_turn_known && start_b.turn != k_no_turn_known && is_present(shape_a) && is_present(shape_b) &&
           !is_sensed(shape_a, shape_b) && !is_sphere(shape_a) && !is_sphere(shape_b);
}

// The axis of a contact as the bodies lie now.
struct LastingAxis {
    vec3 normal;    // unit, from A to B
    float leverage; // how far the contact moves where its bodies move by 1
};

// A face's normal turns as the bodies do in the mean. That of two edges is their cross product: it turns, and the place where they are
// nearest moves along them, by one over the sine between them.
inline LastingAxis lasting_axis(Manifold old, Movement a, Movement b, BodyPose pose_a, BodyPose pose_b)
{
    bool at_face = old.axis < 6u;
    precise vec3 turn = 0.5f * (a.turn + b.turn);
    precise vec3 turned = old.normal + cross3(turn, old.normal);
    vec3 direction = turned;
    if (any_lane(!at_face)) {
        vec3 edge_a = axis_of(rotation_axes(pose_a.rotation), edge_of_a(old.axis));
        vec3 edge_b = axis_of(rotation_axes(pose_b.rotation), edge_of_b(old.axis));
        direction = choose_active(!at_face, cross3(edge_a, edge_b), turned);
    }
    float inverse_length = inverse_sqrt(dot3(direction, direction));
    LastingAxis axis;
    axis.normal = scale3(direction, choose(dot3(direction, old.normal) < 0.0f, -inverse_length, inverse_length));
    axis.leverage = choose(at_face, 1.0f, max(inverse_length, 1.0f));
    return axis;
}

// Separations::way, after a step of this way.
inline float way_after(Separations old, float way, float leverage)
{
    precise float sum = old.way + leverage * way;
    return sum;
}

// Whether the contact of a pair was found where the bodies were.
inline bool was_found_in_place(Separations separations)
{
    return separations.shift.x == 0.0f && separations.shift.y == 0.0f && separations.shift.z == 0.0f;
}

// The part of k_lasting_way beyond which contacts are collided early, in one of sixteen steps (collides_early in step.h). What rests
// creeps by some thousandth of the way a step, and of a thousand contacts one or two would have had it in each: a GPU takes as long for
// these as for many. What creeps by less than a 120th never has it in another step.
const float k_early_share = 0.875f;

// How far a contact may have moved (m).
inline float most_way(bool early, Parameters p)
{
    precise float most = choose(early, k_early_share, 1.0f) * k_lasting_way * p.speculative_distance;
    return most;
}

// `way`: way_after the last step. `most`: most_way. Bodies that are about to move are to be looked at ahead.
inline bool stays(float way, Movement ahead_a, Movement ahead_b, MeetingPoint point, float leverage, float most)
{
    precise float next_way = way + leverage * way_between(ahead_a, ahead_b, point);
    return next_way <= most; // and not where one is no number
}

// ---- bodies that are apart ----

// Where the smaller of two bodies is.
inline MeetingPoint centre_of_smaller(vec3 offset, BodyShape a, BodyShape b)
{
    float radius_a = length3(a.half_extents);
    float radius_b = length3(b.half_extents);
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    MeetingPoint point;
    point.arm_a = choose(radius_b < radius_a, offset, none);
    point.arm_b = choose(radius_b < radius_a, none, vec3(-offset.x, -offset.y, -offset.z));
    point.reach = min(radius_a, radius_b);
    return point;
}

// How far apart they are at least where a collision found no points (m); 0: it is not known, as of bodies that were looked at where they
// will be.
inline float gap_without_points(ContactGeometry g)
{
    bool now = g.shift.x == 0.0f && g.shift.y == 0.0f && g.shift.z == 0.0f;
    return choose(now && g.separations[0] > 0.0f, g.separations[0], 0.0f);
}

// The same once they have moved by `way` at most.
inline float gap_after(float gap, float way)
{
    precise float left = gap - way;
    return choose(left > 0.0f, left, 0.0f); // also where it is no number
}

// Whether collide_moving_shapes need not be asked: they are out of reach, by any axis that it may choose, and not about to meet.
inline bool is_surely_apart(float gap, vec3 motion, Parameters p)
{
    precise float reach = contact_reach(motion, true, p) + length3(motion) + k_axis_persistence + k_rounding;
    return gap > reach;
}

// ---- a contact that lasts ----

// The middle between where the step has taken A's and B's part of a point, from A's centre as it is now.
inline vec3 lasting_anchor(vec3 anchor, vec3 offset, Movement a, Movement b)
{
    precise vec3 arm_b = anchor - offset;
    precise vec3 moved = 0.5f * (movement_at(a, anchor) + movement_at(b, arm_b));
    precise vec3 now = anchor + moved - a.shift;
    return now;
}

// How much farther apart along the normal they are there (m).
inline float opening_at(vec3 normal, vec3 anchor, vec3 offset, Movement a, Movement b)
{
    precise vec3 arm_b = anchor - offset;
    precise vec3 apart = movement_at(b, arm_b) - movement_at(a, anchor);
    return dot3(normal, apart);
}

// Whether a point is near enough yet to be one.
inline bool is_within_reach(Separations separations, uint count, vec3 motion, Parameters p)
{
    float reach = contact_reach(motion, true, p);
    vec4 s = separations.separation;
    return s.x <= reach || (1u < count && s.y <= reach) || (2u < count && s.z <= reach) || (3u < count && s.w <= reach);
}

inline Separations lasting_separations(Separations old, vec4 opening, float way, uint count)
{
    precise vec4 separation = old.separation + opening;
    Separations separations = old;
    separations.separation = vec4(separation.x, choose(1u < count, separation.y, 0.0f), choose(2u < count, separation.z, 0.0f),
                                  choose(3u < count, separation.w, 0.0f));
    separations.way = way;
    return separations;
}

inline Manifold lasting_manifold(Manifold old, vec3 normal, Parameters p)
{
    Manifold manifold = old;
    manifold.normal = normal;
    return carry_over(manifold, old, p);
}
