// SPDX-License-Identifier: MIT
// Box against box: separating axis test, then a contact of faces or edges (thesis, section 3.3). Needs
// narrow_phase/clip_face.shared.glsl and narrow_phase/reduce_points.shared.glsl.
//
// A separating axis is named by a number: 0-2 a face of A with that axis as its normal, 3-5 a face of B, 6 + 3 i + j
// the cross product of A's edge i and B's edge j. The thesis queries vertices (algorithms 5 and 6); a box's support
// point along an axis is known from its half extents, so the distances below are the same in closed form.

// An edge contact must be this much less deep than every face contact to be taken (m). A face gives up to four points
// where an edge gives one, and in a resting stack the two tie.
const float k_face_preference = 2.5e-3f;
// The last step's axis is kept while it is no more than this much worse than the best (m): features must not flip.
const float k_axis_persistence = 1.0e-3f;
// Edges within about 2 degrees of parallel have no usable cross product; the faces cover them.
const float k_parallel = 1.0e-3f;

struct BoxPair {
    Axes a;
    Axes b;
    vec3 half_a;
    vec3 half_b;
    vec3 offset; // from A's centre to B's, world
};

struct AxisQuery {
    float separation; // m, largest over the axes seen: the thesis's "smallest signed distance"
    float score;      // separation and preferences
    uint axis;
};

inline AxisQuery better_axis(AxisQuery best, float separation, float preference, uint axis, uint old_axis)
{
    precise float score = separation + preference + (axis == old_axis ? k_axis_persistence : 0.0f);
    if (score > best.score) {
        best.separation = separation;
        best.score = score;
        best.axis = axis;
    }
    return best;
}

// Separation along a unit direction: distance of the centres less the extents of both boxes.
inline float separation_along(BoxPair p, vec3 direction)
{
    precise float reach_a = abs(dot3(p.a.x, direction)) * p.half_a.x + abs(dot3(p.a.y, direction)) * p.half_a.y +
                            abs(dot3(p.a.z, direction)) * p.half_a.z;
    precise float reach_b = abs(dot3(p.b.x, direction)) * p.half_b.x + abs(dot3(p.b.y, direction)) * p.half_b.y +
                            abs(dot3(p.b.z, direction)) * p.half_b.z;
    precise float separation = abs(dot3(p.offset, direction)) - reach_a - reach_b;
    return separation;
}

// Face queries of both boxes (algorithm 5) and the edge query (algorithm 6).
inline AxisQuery query_axes(BoxPair p, uint old_axis)
{
    AxisQuery best;
    best.separation = -3.0e38f;
    best.score = -3.0e38f;
    best.axis = 0u;
    for (uint i = 0u; i < 6u; i += 1u) {
        vec3 direction = i < 3u ? axis_of(p.a, i) : axis_of(p.b, i - 3u);
        best = better_axis(best, separation_along(p, direction), k_face_preference, i, old_axis);
    }
    for (uint i = 0u; i < 9u; i += 1u) {
        vec3 across = cross3(axis_of(p.a, i / 3u), axis_of(p.b, i % 3u));
        float square = dot3(across, across);
        if (square > k_parallel) {
            vec3 direction = scale3(across, inverse_sqrt(square));
            best = better_axis(best, separation_along(p, direction), 0.0f, 6u + i, old_axis);
        }
    }
    return best;
}

// ---- face contact ----

// The reference box is A; `axis` is its face's axis. `carriers`: of this axis.
inline ContactGeometry face_contact(BoxPair p, uint axis, Carriers carriers, float max_separation)
{
    uint axis_u = axis == 2u ? 0u : axis + 1u;
    uint axis_v = axis_u == 2u ? 0u : axis_u + 1u;
    vec3 n = axis_of(p.a, axis);
    float side = dot3(n, p.offset) < 0.0f ? -1.0f : 1.0f;
    Axes frame; // of the reference face: u, v and the outward normal
    frame.x = axis_of(p.a, axis_u);
    frame.y = axis_of(p.a, axis_v);
    frame.z = scale3(n, side);
    float half_u = component(p.half_a, axis_u);
    float half_v = component(p.half_a, axis_v);
    float half_n = component(p.half_a, axis);

    Axes incident;
    incident.x = to_local(frame, p.b.x);
    incident.y = to_local(frame, p.b.y);
    incident.z = to_local(frame, p.b.z);
    precise vec3 centre = to_local(frame, p.offset) - vec3(0.0f, 0.0f, half_n);

    Candidates candidates = clip_face(incident_face(incident, p.half_b, centre), half_u, half_v, max_separation);
    Picks kept = reduce_points(candidates, carriers);
    ContactGeometry g = no_contact();
    g.normal = frame.z;
    g.count = kept.count;
    for (uint i = 0u; i < 4u; i += 1u) {
        vec3 point = kept.picks[i].point;
        // Projected on the reference face, then moved half-way to the incident one.
        precise vec3 local = vec3(point.x, point.y, half_n + 0.5f * point.z);
        if (i < kept.count) {
            g.points[i] = to_world(frame, local);
            g.separations[i] = point.z;
            g.features[i] = kept.picks[i].feature;
        }
    }
    return g;
}

// ---- edge contact ----

// Closest points of two edges (lines: the separating axis crosses both within their length).
inline ContactGeometry edge_contact(BoxPair p, uint edge_a, uint edge_b, float separation)
{
    vec3 direction_a = axis_of(p.a, edge_a);
    vec3 direction_b = axis_of(p.b, edge_b);
    vec3 across = cross3(direction_a, direction_b);
    float inverse_length = inverse_sqrt(dot3(across, across));
    precise float scale = dot3(across, p.offset) < 0.0f ? -inverse_length : inverse_length;
    vec3 normal = scale3(across, scale); // from A to B

    // A point on each edge: its middle, at the corner of the box that looks along the normal.
    vec3 point_a = vec3(0.0f, 0.0f, 0.0f);
    vec3 point_b = p.offset;
    uint corner = 0u;
    for (uint i = 0u; i < 3u; i += 1u) {
        if (i != edge_a) {
            vec3 axis = axis_of(p.a, i);
            bool positive = dot3(axis, normal) > 0.0f;
            float reach = component(p.half_a, i);
            point_a = add_scaled(point_a, axis, positive ? reach : -reach);
            corner = corner * 2u + (positive ? 1u : 0u);
        }
        if (i != edge_b) {
            vec3 axis = axis_of(p.b, i);
            bool positive = dot3(axis, normal) < 0.0f;
            float reach = component(p.half_b, i);
            point_b = add_scaled(point_b, axis, positive ? reach : -reach);
            corner = corner * 2u + (positive ? 1u : 0u);
        }
    }
    // Minimise |point_a + s a - point_b - t b|: with unit directions and c = a·b, s = (a·d - c b·d) / (1 - c^2).
    precise vec3 d = point_b - point_a;
    float c = dot3(direction_a, direction_b);
    float ad = dot3(direction_a, d);
    float bd = dot3(direction_b, d);
    float inverse = reciprocal(dot3(across, across));
    precise float s = (ad - c * bd) * inverse;
    precise float t = (c * ad - bd) * inverse;
    float reach_a = component(p.half_a, edge_a);
    float reach_b = component(p.half_b, edge_b);
    vec3 on_a = add_scaled(point_a, direction_a, clamp_to(s, -reach_a, reach_a));
    vec3 on_b = add_scaled(point_b, direction_b, clamp_to(t, -reach_b, reach_b));
    precise vec3 middle = 0.5f * (on_a + on_b);
    ContactGeometry g = one_contact(normal, middle, separation);
    g.features[0] = 0x10000u + corner;
    return g;
}

inline ContactGeometry collide_boxes(BoxPair p, Carriers carriers, float max_separation)
{
    AxisQuery query = query_axes(p, carriers.axis);
    if (query.separation > max_separation) return no_contact();
    ContactGeometry g;
    if (query.axis >= 6u) {
        g = edge_contact(p, (query.axis - 6u) / 3u, (query.axis - 6u) % 3u, query.separation);
    } else {
        // The reference box is the one whose face it is.
        bool b_is_reference = query.axis >= 3u;
        BoxPair q = p;
        if (b_is_reference) {
            q.a = p.b;
            q.b = p.a;
            q.half_a = p.half_b;
            q.half_b = p.half_a;
            q.offset = vec3(-p.offset.x, -p.offset.y, -p.offset.z);
        }
        if (carriers.axis != query.axis) carriers = no_carriers();
        g = face_contact(q, b_is_reference ? query.axis - 3u : query.axis, carriers, max_separation);
        if (b_is_reference) g = swap_bodies(g, q.offset);
    }
    g.axis = query.axis;
    g.separation = query.separation;
    return g;
}
