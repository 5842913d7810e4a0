// SPDX-License-Identifier: MIT
// The separating axes of two boxes (thesis, section 3.3), and which of them separates the two most.
//
// An axis is named by a number: 0-2 a face of A with that axis as its normal, 3-5 a face of B, 6 + 3 i + j the cross
// product of A's edge i and B's edge j. The thesis queries vertices (algorithms 5 and 6); a box's support point along an
// axis is known from its half extents, so the distances below are the same in closed form.
// Needs broad_phase/oriented_box.shared.glsl and narrow_phase/contact_geometry.shared.glsl.

// The edges whose cross product an axis is, which is no face's.
inline uint edge_of_a(uint axis) { return choose(axis >= 12u, 2u, choose(axis >= 9u, 1u, 0u)); }
inline uint edge_of_b(uint axis) { return axis - 6u - 3u * edge_of_a(axis); }

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

inline AxisQuery better_axis(AxisQuery best, float separation, float preference, uint axis, uint old_axis)
{
    precise float score = separation + preference + choose(axis == old_axis, k_axis_persistence, 0.0f);
    bool better = score > best.score;
    best.separation = choose(better, separation, best.separation);
    best.score = choose(better, score, best.score);
    best.axis = choose(better, axis, best.axis);
    return best;
}

inline AxisQuery try_faces(AxisQuery best, vec3 separation, uint first_axis, uint old_axis)
{
    best = better_axis(best, separation.x, k_face_preference, first_axis, old_axis);
    best = better_axis(best, separation.y, k_face_preference, first_axis + 1u, old_axis);
    return better_axis(best, separation.z, k_face_preference, first_axis + 2u, old_axis);
}

// Along the cross product of one of A's edges and one of B's. `edge`, `offset`, `half_a`: of B's edge, of B's centre and of A's
// half extents what lies along A's two other axes; `reach_b`: B's extent, as the cross product is long.
inline AxisQuery try_edges(AxisQuery best, vec2 edge, vec2 offset, vec2 half_a, float reach_b, uint axis, uint old_axis)
{
    precise float square = edge.x * edge.x + edge.y * edge.y; // of the length of the cross product
    precise float reach = half_a.x * abs(edge.y) + half_a.y * abs(edge.x) + reach_b;
    precise float apart = abs(edge.x * offset.y - edge.y * offset.x) - reach;
    // The cross product is no longer than one, but for rounding, so where the boxes overlap along it, it can be no better than this.
    precise float most = apart + k_axis_persistence;
    bool may_be_better = apart > 0.0f || most > best.score;
    bool is_tried = square > k_parallel && may_be_better;
    if (any_lane(is_tried)) {
        precise float separation = apart * inverse_sqrt(square);
        best = choose_active(is_tried, better_axis(best, separation, 0.0f, axis, old_axis), best);
    }
    return best;
}

// B's edge along one of its axes with all of A's. `first`, `second`: B's other axes, as A sees them.
inline AxisQuery try_edges_of_b(AxisQuery best, BoxPair p, vec3 edge, vec3 offset, vec3 first, float half_first, vec3 second,
                                float half_second, uint first_axis, uint old_axis)
{
    vec3 half_a = p.half_a;
    precise vec3 reach = abs(second) * half_first + abs(first) * half_second;
    best = try_edges(best, vec2(edge.y, edge.z), vec2(offset.y, offset.z), vec2(half_a.y, half_a.z), reach.x, first_axis, old_axis);
    best = try_edges(best, vec2(edge.z, edge.x), vec2(offset.z, offset.x), vec2(half_a.z, half_a.x), reach.y, first_axis + 3u,
                     old_axis);
    return try_edges(best, vec2(edge.x, edge.y), vec2(offset.x, offset.y), vec2(half_a.x, half_a.y), reach.z, first_axis + 6u,
                     old_axis);
}

// Face queries of both boxes (algorithm 5) and the edge query (algorithm 6). Written out for lanes, which cannot choose
// an axis by its number.
inline AxisQuery query_axes(BoxPair p, uint old_axis)
{
    BoxView b = seen_from_a(p);
    FaceSeparations faces = separate_along_faces(p, b);
    vec3 x = b.axes.x;
    vec3 y = b.axes.y;
    vec3 z = b.axes.z;
    AxisQuery best;
    best.separation = -k_far_apart;
    best.score = -k_far_apart;
    best.axis = 0u; // also of boxes that are nowhere
    best = try_faces(best, faces.a, 0u, old_axis);
    best = try_faces(best, faces.b, 3u, old_axis);
    best = try_edges_of_b(best, p, x, b.offset, y, p.half_b.y, z, p.half_b.z, 6u, old_axis);
    best = try_edges_of_b(best, p, y, b.offset, z, p.half_b.z, x, p.half_b.x, 7u, old_axis);
    return try_edges_of_b(best, p, z, b.offset, x, p.half_b.x, y, p.half_b.y, 8u, old_axis);
}
