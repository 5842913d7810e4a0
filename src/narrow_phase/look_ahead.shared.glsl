// SPDX-License-Identifier: MIT
// Where two bodies will touch, seen from where they are. Needs narrow_phase/manifold.shared.glsl.
//
// Contacts are known before bodies touch. The direction that separates two bodies most now is not always the one in
// which they will meet: a box that slides towards the next tile of a floor is separated from it sideways, yet will run
// onto it. Taken for a contact with the tile's side, that stopped a box of 6 m/s dead. So bodies are brought together
// along their relative motion first (conservative advancement), and the geometry is that of their meeting.

// An overlap thinner than this says nothing about where bodies meet (m): one that rests on a floor overlaps it, and so
// also the side of the next tile, by a little.
const float k_graze = 5.0e-3f;
// How far ahead a meeting counts, in steps: this one, and what of the next the solver sees of it, whose last pass keeps
// gaps open for a sub-step more.
const float k_steps_ahead = 2.0f;
// Bodies that graze are looked at in this many steps' time at most: what moves less is at rest.
const float k_graze_steps = 8.0f;

// Whether a contact spreads along both directions of its plane. Bodies that touch so need no second look:
// the side of the next tile meets a box in a strip as high as the overlap.
inline bool is_broad(ContactGeometry g)
{
    const float least = 4.0f * k_graze * k_graze;
    precise vec3 u = g.points[1] - g.points[0];
    precise vec3 v = g.points[2] - g.points[1];
    return g.count == 4u && dot3(u, u) > least && dot3(v, v) > least;
}

// How far two bodies have been looked ahead.
struct LookAhead {
    float time; // when they were looked at last, in steps
    float next; // when they are to be looked at next
    uint looks;
    bool ends; // they need not be looked at again
};

inline LookAhead begin_look_ahead()
{
    LookAhead ahead;
    ahead.time = 0.0f;
    ahead.next = 0.0f;
    ahead.looks = 0u;
    ahead.ends = false;
    return ahead;
}

const uint k_most_looks = 4u;

// `met`: the bodies at the time `ahead.next`. `motion`: of B as seen from A, in this step (m). Rotation is left out of
// account.
inline LookAhead look_on(LookAhead ahead, ContactGeometry met, vec3 motion)
{
    ahead.time = ahead.next;
    ahead.looks += 1u;
    float closing = -dot3(met.normal, motion);
    precise float distance = met.separation + k_graze;
    precise float within_reach = closing * (k_steps_ahead - ahead.time);
    precise float within_sight = closing * k_graze_steps;
    // They touch, have met, are apart for long enough, or at rest.
    ahead.ends = (met.separation <= 0.0f && is_broad(met)) || distance <= 0.0f || met.separation > within_reach ||
                 distance > within_sight || ahead.looks == k_most_looks;
    if (!ahead.ends) {
        precise float later = ahead.time + distance * reciprocal(closing);
        ahead.next = later;
    }
    return ahead;
}

// The contact of two bodies, by where they are, `now`, and where they were looked at last, `time` steps later.
inline ContactGeometry contact_ahead(ContactGeometry now, ContactGeometry met, float time, vec3 motion)
{
    if (time == 0.0f) return now;
    // Already in contact there, as is what rests or has just landed.
    if (now.separation <= 0.0f && met.axis == now.axis && met.axis != k_axis_none) return now;

    precise float approached = dot3(met.normal, motion) * time;
    precise float separation = met.separation - approached;
    // What opens from overlap along this normal is no contact: the bodies pass each other by.
    if (separation < -2.0f * k_graze) {
        if (now.separation <= 0.0f) return now;
        return no_contact();
    }
    met.separation = separation;
    precise float separation_0 = met.separations[0] - approached;
    precise float separation_1 = met.separations[1] - approached;
    precise float separation_2 = met.separations[2] - approached;
    precise float separation_3 = met.separations[3] - approached;
    met.separations[0] = separation_0;
    met.separations[1] = separation_1;
    met.separations[2] = separation_2;
    met.separations[3] = separation_3;
    met.shift = scale3(motion, time);
    return met;
}

inline ContactGeometry collide_moving_shapes(BodyPose pose_a, BodyShape shape_a, BodyPose pose_b, BodyShape shape_b,
                                             vec3 motion, Carriers carriers, float max_separation)
{
    vec3 start = pose_b.position;
    ContactGeometry now = no_contact();
    ContactGeometry met = now;
    LookAhead ahead = begin_look_ahead();
    while (!ahead.ends) {
        pose_b.position = add_scaled(start, motion, ahead.next);
        met = collide_shapes(pose_a, shape_a, pose_b, shape_b, carriers, max_separation);
        if (ahead.looks == 0u) now = met;
        ahead = look_on(ahead, met, motion);
    }
    return contact_ahead(now, met, ahead.time, motion);
}
