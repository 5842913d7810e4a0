// SPDX-License-Identifier: MIT
// The separating axes of two boxes (thesis, section 3.3), and which of them separates the two most.
//
// An axis is named by a number: 0-2 a face of A with that axis as its normal, 3-5 a face of B, 6 + 3 i + j the cross
// product of A's edge i and B's edge j. The thesis queries vertices (algorithms 5 and 6); a box's support point along an
// axis is known from its half extents, so the distances below are the same in closed form.
// Needs broad_phase/oriented_box.shared.glsl and narrow_phase/contact_geometry.shared.glsl.

// An edge contact must be this much less deep than every face contact to be taken (m). A face gives up to four points
// where an edge gives one, and in a resting stack the two tie.
const float k_face_preference = 2.5e-3f;
// The last step's axis is kept while it is no more than this much worse than the best (m): features must not flip.
const float k_axis_persistence = 1.0e-3f;
// Edges within about 2 degrees of parallel have no usable cross product; the faces cover them.
const float k_parallel = 1.0e-3f;

inline BoxPair make_box_pair(BodyPose pose_a, BodyShape shape_a, BodyPose pose_b, BodyShape shape_b)
{
    return make_box_pair(pose_a.position, pose_a.rotation, shape_a.half_extents, pose_b.position, pose_b.rotation,
                         shape_b.half_extents);
}

struct AxisQuery {
    float separation; // m, largest over the axes seen: the thesis's "smallest signed distance"
    float score;      // separation and preferences
    uint axis;
};

// For a caller that has not asked yet.
inline AxisQuery no_query()
{
    AxisQuery none;
    none.separation = -3.0e38f;
    none.score = -3.0e38f;
    none.axis = k_axis_none;
    return none;
}

inline AxisQuery better_axis(AxisQuery best, float separation, float preference, uint axis, uint old_axis)
{
    precise float score = separation + preference + choose(axis == old_axis, k_axis_persistence, 0.0f);
    bool better = score > best.score;
    best.separation = choose(better, separation, best.separation);
    best.score = choose(better, score, best.score);
    best.axis = choose(better, axis, best.axis);
    return best;
}

inline AxisQuery try_face(AxisQuery best, BoxPair p, vec3 normal, uint axis, uint old_axis)
{
    return better_axis(best, separation_along(p, normal), k_face_preference, axis, old_axis);
}

inline AxisQuery try_edges(AxisQuery best, BoxPair p, vec3 edge_a, vec3 edge_b, uint axis, uint old_axis)
{
    vec3 across = cross3(edge_a, edge_b);
    float square = dot3(across, across);
    if (any_lane(square > k_parallel)) {
        vec3 direction = scale3(across, inverse_sqrt(square));
        best = choose_active(square > k_parallel,
                             better_axis(best, separation_along(p, direction), 0.0f, axis, old_axis), best);
    }
    return best;
}

// Face queries of both boxes (algorithm 5) and the edge query (algorithm 6). Written out for lanes, which cannot choose
// an axis by its number.
inline AxisQuery query_axes(BoxPair p, uint old_axis)
{
    AxisQuery best = no_query();
    best.axis = 0u; // also of boxes that are nowhere
    best = try_face(best, p, p.a.x, 0u, old_axis);
    best = try_face(best, p, p.a.y, 1u, old_axis);
    best = try_face(best, p, p.a.z, 2u, old_axis);
    best = try_face(best, p, p.b.x, 3u, old_axis);
    best = try_face(best, p, p.b.y, 4u, old_axis);
    best = try_face(best, p, p.b.z, 5u, old_axis);
    best = try_edges(best, p, p.a.x, p.b.x, 6u, old_axis);
    best = try_edges(best, p, p.a.x, p.b.y, 7u, old_axis);
    best = try_edges(best, p, p.a.x, p.b.z, 8u, old_axis);
    best = try_edges(best, p, p.a.y, p.b.x, 9u, old_axis);
    best = try_edges(best, p, p.a.y, p.b.y, 10u, old_axis);
    best = try_edges(best, p, p.a.y, p.b.z, 11u, old_axis);
    best = try_edges(best, p, p.a.z, p.b.x, 12u, old_axis);
    best = try_edges(best, p, p.a.z, p.b.y, 13u, old_axis);
    best = try_edges(best, p, p.a.z, p.b.z, 14u, old_axis);
    return best;
}
