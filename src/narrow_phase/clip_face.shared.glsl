// SPDX-License-Identifier: MIT
// What a face has in common with another box: the corners of a clipped rectangle (thesis, algorithm 7).
//
// Differs from the thesis, which clips a list of points by one side plane after the other: here every point that there
// can be has a slot of its own, and no index is known only at run time. A GPU cannot index registers; lists that grow
// cost more there than all other arithmetic of a pair.
//
// Everything is seen in the reference face's frame: x and y along the face, z above it. The face is the rectangle
// |x| <= half_u, |y| <= half_v.

// What a tie may err by, of the sum of the half extents of both faces. Sums and products of coordinates are off by a
// fifth of it.
const float k_tie = 1.0e-6f;
// Edges of the incident face are 0-3, side planes of the reference face 4-7: at +x, +y, -x, -y. Both run anticlockwise.
const uint k_side_plane = 4u;

// The face of the incident box which looks most against the reference normal: middle ± u ± v.
struct IncidentFace {
    vec3 middle;
    vec3 u;
    vec3 v;
    float half_u; // m, length of u
    float half_v;
    float area;   // a quarter of the face's, seen along z; positive: u to v is anticlockwise
    uint label;   // of its edge 0; the face is part of it, so that a point on another face is another feature
};

// `r`: incident axes in the reference frame's directions (u, v, n); `centre`: incident centre there.
inline IncidentFace incident_face(Axes r, vec3 half_extents, vec3 centre)
{
    uint axis = 0u;
    if (abs(r.y.z) > abs(r.x.z)) axis = 1u;
    if (abs(r.z.z) > max(abs(r.x.z), abs(r.y.z))) axis = 2u;
    vec3 face_normal = axis_of(r, axis);
    float side = face_normal.z > 0.0f ? -1.0f : 1.0f;
    uint axis_u = axis == 2u ? 0u : axis + 1u;
    uint axis_v = axis_u == 2u ? 0u : axis_u + 1u;
    IncidentFace face;
    face.half_u = component(half_extents, axis_u);
    face.half_v = component(half_extents, axis_v);
    face.middle = add_scaled(centre, face_normal, side * component(half_extents, axis));
    vec3 u = scale3(axis_of(r, axis_u), face.half_u);
    face.v = scale3(axis_of(r, axis_v), face.half_v);
    precise float area = u.x * face.v.y - u.y * face.v.x;
    face.u = area < 0.0f ? vec3(-u.x, -u.y, -u.z) : u;
    face.area = abs(area);
    face.label = 8u * (2u * axis + (side > 0.0f ? 1u : 0u));
    return face;
}

// Corner i; edge i leads from it to the next.
inline vec3 corner_of(IncidentFace face, uint i)
{
    float sign_u = i == 0u || i == 3u ? 1.0f : -1.0f;
    float sign_v = i < 2u ? 1.0f : -1.0f;
    precise vec3 corner = face.middle + face.u * sign_u + face.v * sign_v;
    return corner;
}

// The name of a point: the edge or side plane along which the outline comes, and that along which it goes on.
inline uint feature_between(uint label_before, uint label)
{
    return label_before * 64u + label;
}

// ---- candidates ----

// Slots 2 i and 2 i + 1: where edge i of the incident face begins inside the rectangle, and where it leaves it. Slot
// 8 + k: corner k of the rectangle, if the incident face covers it.
const uint k_candidate_count = 12u;

struct Candidates {
    vec3 points[12];
    uint features[12];
    uint present; // a bit a slot
};

inline bool is_present(Candidates candidates, uint slot)
{
    return ((candidates.present >> slot) & 1u) != 0u;
}

// The part of an edge that is inside the side planes seen so far, as fractions of its length.
struct EdgeSpan {
    float enter;  // negative: it begins at the edge's corner
    float leave;  // above 1.5: it does not leave
    uint before;  // label of what leads to where it begins
    uint after;   // label of the plane through which it leaves
};

// `from`, `to`: how far the edge's ends are outside a side plane; `inverse`: 1 / (from - to), needed only where one of
// the two is inside.
inline EdgeSpan cut_span(EdgeSpan span, float from, float to, float inverse, uint label)
{
    bool begins_outside = from > 0.0f;
    bool ends_outside = to > 0.0f;
    precise float crossing = from * inverse;
    if (begins_outside && ends_outside) span.enter = 3.0f; // nothing is left
    if (begins_outside && !ends_outside && crossing > span.enter) {
        span.enter = crossing;
        span.before = label;
    }
    if (!begins_outside && ends_outside && crossing < span.leave) {
        span.leave = crossing;
        span.after = label;
    }
    return span;
}

// The part of an edge over the rectangle (Liang and Barsky). `before`: label of the edge before it.
inline EdgeSpan clip_edge(vec3 from, vec3 to, float half_u, float half_v, uint before)
{
    EdgeSpan span;
    span.enter = -1.0f;
    span.leave = 2.0f;
    span.before = before;
    span.after = before;
    precise float inverse_x = reciprocal(from.x - to.x);
    precise float inverse_y = reciprocal(from.y - to.y);
    precise vec4 outside_from = vec4(from.x - half_u, from.y - half_v, -from.x - half_u, -from.y - half_v);
    precise vec4 outside_to = vec4(to.x - half_u, to.y - half_v, -to.x - half_u, -to.y - half_v);
    span = cut_span(span, outside_from.x, outside_to.x, inverse_x, k_side_plane);
    span = cut_span(span, outside_from.y, outside_to.y, inverse_y, k_side_plane + 1u);
    span = cut_span(span, outside_from.z, outside_to.z, -inverse_x, k_side_plane + 2u);
    span = cut_span(span, outside_from.w, outside_to.w, -inverse_y, k_side_plane + 3u);
    return span;
}

// All corners of what the incident face and the rectangle have in common, seen along z; none that is higher than
// `max_separation`. In a tie, of which aligned boxes are full, an edge may lie on either side of a plane by rounding:
// the corner of the rectangle is let in then, whether there is a point already or not. So one may come twice, but none
// is lost.
inline Candidates clip_face(IncidentFace face, float half_u, float half_v, float max_separation)
{
    Candidates candidates;
    candidates.present = 0u;
    for (uint i = 0u; i < 4u; i += 1u) {
        vec3 from = corner_of(face, i);
        vec3 to = corner_of(face, (i + 1u) & 3u);
        EdgeSpan span = clip_edge(from, to, half_u, half_v, face.label + ((i + 3u) & 3u));
        precise vec3 edge = to - from;
        vec3 begin = add_scaled(from, edge, max(span.enter, 0.0f));
        vec3 end = add_scaled(from, edge, span.leave);
        bool is_inside = span.enter <= span.leave;
        candidates.points[2u * i] = begin;
        candidates.features[2u * i] = feature_between(span.before, face.label + i);
        if (is_inside && begin.z <= max_separation) candidates.present |= 1u << (2u * i);
        candidates.points[2u * i + 1u] = end;
        candidates.features[2u * i + 1u] = feature_between(face.label + i, span.after);
        if (is_inside && span.leave < 1.5f && end.z <= max_separation) candidates.present |= 2u << (2u * i);
    }
    precise float tie = k_tie * (half_u + half_v + face.half_u + face.half_v);
    precise float reach_u = face.area + tie * face.half_v;
    precise float reach_v = face.area + tie * face.half_u;
    float inverse = reciprocal(face.area);
    for (uint i = 0u; i < 4u; i += 1u) {
        float x = i == 0u || i == 3u ? half_u : -half_u;
        float y = i < 2u ? half_v : -half_v;
        precise float dx = x - face.middle.x;
        precise float dy = y - face.middle.y;
        // Twice the areas of the triangles with v and u: the corner's coordinates in the incident face, times its area.
        precise float along_u = dx * face.v.y - dy * face.v.x;
        precise float along_v = face.u.x * dy - face.u.y * dx;
        precise float z = face.middle.z + (along_u * face.u.z + along_v * face.v.z) * inverse;
        candidates.points[8u + i] = vec3(x, y, z);
        candidates.features[8u + i] = feature_between(k_side_plane + i, k_side_plane + ((i + 1u) & 3u));
        if (abs(along_u) <= reach_u && abs(along_v) <= reach_v && z <= max_separation) candidates.present |= 256u << i;
    }
    return candidates;
}
