// SPDX-License-Identifier: MIT
// A body's own box, and its world bounding box (thesis, section 3.2).

// How far beyond its shape a body looks for contacts (m): as far as it moves in a step, so that it stops at what it hits
// instead of in it.
inline float contact_margin(BodyVelocity velocity, Parameters p)
{
    precise float margin = 0.5f * p.speculative_distance + length3(velocity.linear) * p.dt;
    return margin;
}

// A contact that there is lasts until its bodies are this much farther apart than where one begins (m). In a heap at rest some gap
// always is as wide as that, and changes by micrometres: its contact would come and go, and the constraint graph with it.
const float k_parting = 2.5e-4f;

// Of B as seen from A, in this step (m).
inline vec3 motion_between(BodyVelocity a, BodyVelocity b, Parameters p)
{
    precise vec3 motion = (b.linear - a.linear) * p.dt;
    return motion;
}

// How far apart two bodies may be that have a contact (m). `motion`: of B as seen from A, in this step (m).
inline float contact_reach(vec3 motion, bool had_contact, Parameters p)
{
    precise float reach = p.speculative_distance + length3(motion) + choose(had_contact, k_parting, 0.0f);
    return reach;
}

inline uint kind_of(BodyShape shape) { return (shape.type >> 8) & 255u; }
inline bool is_present(BodyShape shape) { return kind_of(shape) != k_kind_absent; }
inline bool is_movable(BodyShape shape) { return kind_of(shape) == k_kind_rigid; } // contacts push it
inline bool is_sensor(BodyShape shape) { return (shape.type & k_sensor_bit) != 0u; }
inline bool is_sphere(BodyShape shape) { return (shape.type & 255u) == k_shape_sphere; }
inline bool is_mover(BodyShape shape) { return is_movable(shape) || kind_of(shape) == k_kind_kinematic; }

// Of BodyInertia, but for those that islands and hubs add.
inline uint traits_of_body(BodyShape shape, BodyPose pose)
{
    bool thawed = (pose.flags & k_body_frozen) == 0u;
    return choose(is_movable(shape) && thawed, k_trait_movable, 0u) | choose(is_mover(shape) && thawed, k_trait_moves, 0u) |
           choose(is_sphere(shape), k_trait_round, 0u);
}

// Whether a body is where the caller has just put it. One that never moves is there anyway.
inline bool is_placed(BodyPose pose, BodyShape shape)
{
    return (pose.flags & k_body_placed) != 0u || !is_mover(shape);
}

// How far a body, or at most a point of it, comes by a movement and a turn, which is small. A sphere's turn changes
// nothing for others.
inline float way_of(vec3 movement, vec4 turn, BodyShape shape)
{
    float reach = 0.0f;
    if (any_lane(!is_sphere(shape))) reach = choose_active(!is_sphere(shape), length3(shape.half_extents), 0.0f);
    float half_angle = length3(vec3(turn.x, turn.y, turn.z));
    precise float way = length3(movement) + 2.0f * half_angle * reach;
    return way;
}

inline OrientedBox make_oriented_box(BodyPose pose, BodyVelocity velocity, BodyShape shape, Parameters p)
{
    OrientedBox box;
    box.centre = pose.position;
    box.margin = contact_margin(velocity, p);
    box.rotation = pose.rotation;
    if (any_lane(is_sphere(shape)))
        box.rotation = choose_active(is_sphere(shape), vec4(0.0f, 0.0f, 0.0f, 1.0f), pose.rotation);
    box.half_extents = shape.half_extents;
    box.type = shape.type;
    return box;
}

inline BodyShape shape_of(OrientedBox box)
{
    BodyShape shape;
    shape.half_extents = box.half_extents;
    shape.type = box.type;
    return shape;
}

inline Aabb compute_aabb(OrientedBox oriented)
{
    // The extent along a world axis sums what each box axis contributes to it.
    Axes axes = rotation_axes(oriented.rotation);
    vec3 half_extents = oriented.half_extents;
    float margin = oriented.margin;
    precise vec3 extent = abs(axes.x) * half_extents.x + abs(axes.y) * half_extents.y + abs(axes.z) * half_extents.z;
    precise vec3 reach = extent + vec3(margin, margin, margin);
    precise vec3 lower = oriented.centre - reach;
    precise vec3 upper = oriented.centre + reach;
    BodyShape shape = shape_of(oriented);
    Aabb box;
    box.lower = lower;
    box.upper = upper;
    box.margin = margin;
    box.movable = choose(is_movable(shape) || is_sensor(shape), 1u, 0u); // sensors see bodies that nothing pushes too
    if (any_lane(!is_present(shape))) { // overlaps nothing
        box.lower = choose_active(!is_present(shape), vec3(3.0e38f, 3.0e38f, 3.0e38f), lower);
        box.upper = choose_active(!is_present(shape), vec3(-3.0e38f, -3.0e38f, -3.0e38f), upper);
    }
    return box;
}

// Whether two boxes overlap (thesis, algorithm 2; touching counts, from both sides alike), and at least one of the bodies
// can be pushed.
inline bool is_candidate(Aabb a, Aabb b)
{
    return a.lower.x <= b.upper.x && a.upper.x >= b.lower.x && a.lower.y <= b.upper.y && a.upper.y >= b.lower.y &&
           a.lower.z <= b.upper.z && a.upper.z >= b.lower.z && (a.movable | b.movable) != 0u;
}

// Whether they do, or would if one of them reached k_parting further: then the bodies may still have a contact.
inline bool is_still_candidate(Aabb a, Aabb b)
{
    precise vec3 lower = a.lower - vec3(k_parting, k_parting, k_parting);
    precise vec3 upper = a.upper + vec3(k_parting, k_parting, k_parting);
    a.lower = lower;
    a.upper = upper;
    return is_candidate(a, b);
}

inline Pair make_pair(uint body_1, uint body_2)
{
    Pair pair;
    pair.body_a = min(body_1, body_2);
    pair.body_b = max(body_1, body_2);
    return pair;
}
