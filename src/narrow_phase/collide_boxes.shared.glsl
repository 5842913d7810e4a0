// SPDX-License-Identifier: MIT
// Box against box: separating axis test, clipping, reduction (thesis, section 3.3).
// Needs narrow_phase/box_axes.shared.glsl, and narrow_phase/polygon.glsl, polygon.h or lane_polygon.h.

// A point that is not this much deeper than a corner of the contact's outline is not worth giving up the corner (m).
const float k_depth_tie = 1.0e-3f;
// A point that is this much farther above the other box than the deepest one, or than its surface, carries nothing soon
// (m).
const float k_near = 2.5e-3f;
// What a point is worth, however large the area that it gives.
const uint k_worth_far = 0u;
const uint k_worth_near = 1u;
const uint k_worth_carrying = 2u; // it carried load in the last step

// ---- face contact ----

// A polygon is convex, in the reference face's frame: x and y along the face, z above it. Edge i runs from corner i to
// the next and carries a label: 0-3 an edge of the incident face, 4-7 a side plane of the reference face.

// Sutherland-Hodgman against one side plane (algorithm 7): keeps what has sign * (x or y) <= limit.
inline Polygon clip_polygon(Polygon polygon, uint axis, float sign, float limit, uint label)
{
    Polygon result = polygon_beside(polygon);
    Corner from = corner_of(polygon, 0u);
    precise float distance_from = sign * component(from.position, axis) - limit;
    for (uint i = 0u; any_lane(i < polygon.count); i += 1u) {
        Corner to = corner_after(polygon, i);
        precise float distance_to = sign * component(to.position, axis) - limit;
        bool is_there = holds_here(i < polygon.count);
        bool inside_from = distance_from <= 0.0f;
        bool inside_to = distance_to <= 0.0f;
        bool stays = is_there && inside_from;
        bool crosses = is_there && inside_from != inside_to;
        if (any_lane(stays)) add_corner(result, stays, from.position, from.label);
        if (any_lane(crosses)) {
            precise float t = distance_from * reciprocal(distance_from - distance_to);
            precise vec3 crossing = from.position + (to.position - from.position) * t;
            // On the way out the next edge runs along the plane; on the way in it is the rest of this edge.
            add_corner(result, crosses, crossing, choose(inside_from, label, from.label));
        }
        from = to;
        distance_from = distance_to;
    }
    return result;
}

// The face of the incident box which looks most against the reference normal, as a polygon in the reference frame.
// `r`: incident axes in the reference frame's directions (u, v, n); `centre`: incident centre there.
inline Polygon incident_face(Axes r, vec3 half_extents, vec3 centre)
{
    uint axis = choose(abs(r.y.z) > abs(r.x.z), 1u, 0u);
    axis = choose(abs(r.z.z) > max(abs(r.x.z), abs(r.y.z)), 2u, axis);
    vec3 face_normal = axis_of(r, axis);
    float side = choose(face_normal.z > 0.0f, -1.0f, 1.0f);
    uint axis_u = choose(axis == 2u, 0u, axis + 1u);
    uint axis_v = choose(axis_u == 2u, 0u, axis_u + 1u);
    precise vec3 middle = centre + face_normal * (side * component(half_extents, axis));
    precise vec3 u = axis_of(r, axis_u) * component(half_extents, axis_u);
    precise vec3 v = axis_of(r, axis_v) * component(half_extents, axis_v);
    precise vec3 p0 = middle + u + v;
    precise vec3 p1 = middle - u + v;
    precise vec3 p2 = middle - u - v;
    precise vec3 p3 = middle + u - v;
    // The face is part of the label, so that a point on another face is another feature.
    uint label = 8u * (2u * axis + choose(side > 0.0f, 1u, 0u));
    Polygon polygon = empty_polygon();
    add_corner(polygon, true, p0, label);
    add_corner(polygon, true, p1, label + 1u);
    add_corner(polygon, true, p2, label + 2u);
    add_corner(polygon, true, p3, label + 3u);
    return polygon;
}

// Twice the signed area of a triangle, seen in the reference face.
inline float triangle_area(vec3 a, vec3 b, vec3 c)
{
    precise float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return area;
}

// Point i's worth, of all points' in two bits each.
inline uint worth_of(uint worths, uint i)
{
    return (worths >> (2u * i)) & 3u;
}

// The best candidate so far, a corner of the polygon.
struct Pick {
    uint point;
    uint worth;
    float gain; // 0: none yet
};

inline Pick no_pick(uint point)
{
    Pick pick;
    pick.point = point;
    pick.worth = k_worth_far;
    pick.gain = 0.0f;
    return pick;
}

inline Pick better_pick(Pick best, Polygon polygon, uint point, uint worth, float gain)
{
    bool better = holds_here(point < polygon.count) && gain > 0.0f && (worth > best.worth || (worth == best.worth && gain > best.gain));
    best.point = choose(better, point, best.point);
    best.worth = choose(better, worth, best.worth);
    best.gain = choose(better, gain, best.gain);
    return best;
}

// The name of a point: the edge that ends there, and the one that begins there.
inline uint feature_between(uint label_before, uint label)
{
    return label_before * 64u + label;
}

inline uint feature_of(Polygon polygon, uint i)
{
    uint before = choose(i > 0u, i, polygon.count) - 1u;
    return feature_between(corner_at(polygon, before).label, corner_at(polygon, i).label);
}

// Which four points to keep of more (algorithm 8): the deepest, the farthest from it, the one that makes the largest
// triangle with these, and the one that adds most area beyond its sides. Returns a bit a point.
//
// Differs from the thesis in two ways. Of points that are about as deep, the one farthest from the middle is taken
// first: in a resting contact all are, and clipping leaves some amid a side; to start from one of those costs a corner,
// and a tower rocks on the three that are left. And a larger area is no reason to give up what matters: the first two
// are of those that carried load, and the others of those that are near. A box that stands on an edge has few of
// either, and rocks for ever where one comes and goes.
inline uint reduce_points(Polygon polygon, Carriers carriers)
{
    precise float inverse_count = reciprocal(float(polygon.count));
    vec3 middle = vec3(0.0f, 0.0f, 0.0f);
    uint deepest = 0u;
    float lowest = k_far_apart;
    for (uint i = 0u; any_lane(i < polygon.count); i += 1u) {
        bool is_there = holds_here(i < polygon.count);
        vec3 corner = corner_of(polygon, i).position;
        bool is_lower = is_there && corner.z < lowest;
        middle = choose_active(is_there, add_scaled(middle, corner, inverse_count), middle);
        lowest = choose(is_lower, corner.z, lowest);
        deepest = choose(is_lower, i, deepest);
    }
    precise float near = max(lowest, 0.0f) + k_near;
    uint worths = 0u;
    uint before = corner_at(polygon, polygon.count - 1u).label;
    Pick first = no_pick(deepest);
    for (uint i = 0u; any_lane(i < polygon.count); i += 1u) {
        Corner corner = corner_of(polygon, i);
        uint worth = choose(corner.position.z <= near, k_worth_near, k_worth_far);
        worth = choose(carried_load(carriers, feature_between(before, corner.label)), k_worth_carrying, worth);
        worths |= worth << (2u * i);
        before = corner.label;
        precise vec3 d = corner.position - middle;
        precise float square = d.x * d.x + d.y * d.y;
        first = better_pick(first, polygon, i, worth, square);
    }
    precise float deeper = corner_at(polygon, first.point).position.z - lowest;
    first.point = choose(deeper > k_depth_tie, deepest, first.point);
    vec3 a = corner_at(polygon, first.point).position;
    Pick second = no_pick(first.point);
    for (uint i = 0u; any_lane(i < polygon.count); i += 1u) {
        precise vec3 d = corner_of(polygon, i).position - a;
        precise float square = d.x * d.x + d.y * d.y;
        second = better_pick(second, polygon, i, worth_of(worths, i), square);
    }
    vec3 b = corner_at(polygon, second.point).position;
    Pick third = no_pick(first.point);
    for (uint i = 0u; any_lane(i < polygon.count); i += 1u) {
        float area = abs(triangle_area(a, b, corner_of(polygon, i).position));
        third = better_pick(third, polygon, i, min(worth_of(worths, i), k_worth_near), area);
    }
    vec3 c = corner_at(polygon, third.point).position;
    float turn = choose(triangle_area(a, b, c) < 0.0f, -1.0f, 1.0f);
    Pick fourth = no_pick(first.point);
    for (uint i = 0u; any_lane(i < polygon.count); i += 1u) {
        vec3 p = corner_of(polygon, i).position;
        // The area beyond a side is negative in the triangle's own orientation.
        float inside = min(turn * triangle_area(a, b, p),
                           min(turn * triangle_area(b, c, p), turn * triangle_area(c, a, p)));
        fourth = better_pick(fourth, polygon, i, min(worth_of(worths, i), k_worth_near), -inside);
    }
    return (1u << first.point) | (1u << second.point) | (1u << third.point) | (1u << fourth.point);
}

inline uint without_lowest(uint corners) { return corners & (corners - 1u); }

// Point i of the contact is the lowest of `corners`, a bit each, if there is one.
inline ContactGeometry keep_corner(ContactGeometry g, int i, Polygon polygon, uint corners, Axes frame, float half_n)
{
    bool is_there = corners != 0u;
    if (any_lane(is_there)) {
        uint lowest = uint(findLSB(corners));
        vec3 corner = corner_at(polygon, lowest).position;
        // Projected on the reference face, then moved half-way to the incident one.
        precise vec3 local = vec3(corner.x, corner.y, half_n + 0.5f * corner.z);
        g.points[i] = choose_active(is_there, to_world(frame, local), g.points[i]);
        g.separations[i] = choose_active(is_there, corner.z, g.separations[i]);
        g.features[i] = choose_active(is_there, feature_of(polygon, lowest), g.features[i]);
    }
    return g;
}

// The reference box is A; `axis` is its face's axis. `carriers`: of this axis.
inline ContactGeometry face_contact(BoxPair p, uint axis, Carriers carriers, float max_separation)
{
    uint axis_u = choose(axis == 2u, 0u, axis + 1u);
    uint axis_v = choose(axis_u == 2u, 0u, axis_u + 1u);
    vec3 n = axis_of(p.a, axis);
    float side = choose(dot3(n, p.offset) < 0.0f, -1.0f, 1.0f);
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

    Polygon polygon = incident_face(incident, p.half_b, centre);
    polygon = clip_polygon(polygon, 0u, 1.0f, half_u, 4u);
    polygon = clip_polygon(polygon, 0u, -1.0f, half_u, 5u);
    polygon = clip_polygon(polygon, 1u, 1.0f, half_v, 6u);
    polygon = clip_polygon(polygon, 1u, -1.0f, half_v, 7u);

    uint kept = (1u << polygon.count) - 1u;
    bool are_many = polygon.count > 4u;
    if (any_lane(are_many)) kept = choose_active(are_many, reduce_points(polygon, carriers), kept);
    for (uint i = 0u; any_lane(i < polygon.count); i += 1u) {
        kept &= ~(choose(corner_of(polygon, i).position.z > max_separation, 1u, 0u) << i);
    }
    ContactGeometry g = no_contact();
    g.normal = frame.z;
    g.count = uint(bitCount(kept));
    // Written out, so that every place in the arrays is known to the compiler.
    g = keep_corner(g, 0, polygon, kept, frame, half_n);
    kept = without_lowest(kept);
    g = keep_corner(g, 1, polygon, kept, frame, half_n);
    kept = without_lowest(kept);
    g = keep_corner(g, 2, polygon, kept, frame, half_n);
    kept = without_lowest(kept);
    g = keep_corner(g, 3, polygon, kept, frame, half_n);
    return g;
}

// ---- edge contact ----

// An edge whose normal comes within about 2 degrees of a face's lies on that face. Its one point jumps from end to end of the
// edge when the boxes turn a little, where the face has points at both: a box that was pinched 2 cm deep trembled at
// 0.25 m/s for seconds.
const float k_almost_normal = 0.9995f; // the angle's cosine

inline bool is_almost_normal(vec3 across, vec3 axis)
{
    precise float along = dot3(across, axis);
    return along * along > k_almost_normal * k_almost_normal * dot3(across, across);
}

// The axis to collide along: the one that separates the boxes most, or the face that it stands for; where there are two
// such faces, the last step's if it is one of them. Boxes that do not touch yet have no end of an edge to lose.
inline uint axis_of_contact(BoxPair p, AxisQuery query, uint old_axis)
{
    uint axis = query.axis;
    bool may_lie_on_face = axis >= 6u && !(query.separation > k_near);
    if (any_lane(may_lie_on_face)) {
        vec3 across = cross3(axis_of(p.a, edge_of_a(axis)), axis_of(p.b, edge_of_b(axis)));
        for (uint face = 0u; any_lane(face < 6u); face += 1u) {
            vec3 normal = choose(face < 3u, axis_of(p.a, face), axis_of(p.b, face - 3u));
            bool is_free = may_lie_on_face && (axis >= 6u || face == old_axis);
            axis = choose(is_free && is_almost_normal(across, normal), face, axis);
        }
    }
    return axis;
}

// Closest points of two edges (lines: the separating axis crosses both within their length).
inline ContactGeometry edge_contact(BoxPair p, uint edge_a, uint edge_b, float separation)
{
    vec3 direction_a = axis_of(p.a, edge_a);
    vec3 direction_b = axis_of(p.b, edge_b);
    vec3 across = cross3(direction_a, direction_b);
    float inverse_length = inverse_sqrt(dot3(across, across));
    precise float scale = choose(dot3(across, p.offset) < 0.0f, -inverse_length, inverse_length);
    vec3 normal = scale3(across, scale); // from A to B

    // A point on each edge: its middle, at the corner of the box that looks along the normal.
    vec3 point_a = vec3(0.0f, 0.0f, 0.0f);
    vec3 point_b = p.offset;
    uint corner = 0u;
    for (uint i = 0u; any_lane(i < 3u); i += 1u) {
        vec3 axis = axis_of(p.a, i);
        bool positive = dot3(axis, normal) > 0.0f;
        float reach = component(p.half_a, i);
        point_a = choose(i != edge_a, add_scaled(point_a, axis, choose(positive, reach, -reach)), point_a);
        corner = choose(i != edge_a, corner * 2u + choose(positive, 1u, 0u), corner);

        axis = axis_of(p.b, i);
        positive = dot3(axis, normal) < 0.0f;
        reach = component(p.half_b, i);
        point_b = choose(i != edge_b, add_scaled(point_b, axis, choose(positive, reach, -reach)), point_b);
        corner = choose(i != edge_b, corner * 2u + choose(positive, 1u, 0u), corner);
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

inline BoxPair swap_boxes(BoxPair p)
{
    BoxPair q;
    q.a = p.b;
    q.b = p.a;
    q.half_a = p.half_b;
    q.half_b = p.half_a;
    q.offset = vec3(-p.offset.x, -p.offset.y, -p.offset.z);
    return q;
}

// The reference box is the one whose face it is: `axis` is below 6.
inline ContactGeometry contact_at_face(BoxPair p, uint axis, Carriers carriers, float max_separation)
{
    bool b_is_reference = axis >= 3u;
    BoxPair q = p;
    if (any_lane(b_is_reference)) q = choose_active(b_is_reference, swap_boxes(p), p);
    bool is_another = carriers.axis != axis;
    if (any_lane(is_another)) carriers = choose_active(is_another, no_carriers(), carriers);
    ContactGeometry g = face_contact(q, choose(b_is_reference, axis - 3u, axis), carriers, max_separation);
    if (any_lane(b_is_reference)) g = choose_active(b_is_reference, swap_bodies(g, q.offset), g);
    g.axis = axis;
    return g;
}

inline ContactGeometry contact_at_edges(BoxPair p, AxisQuery query)
{
    ContactGeometry g = edge_contact(p, edge_of_a(query.axis), edge_of_b(query.axis), query.separation);
    g.axis = query.axis;
    return g;
}

inline ContactGeometry collide_boxes(BoxPair p, Carriers carriers, float max_separation)
{
    AxisQuery query = query_axes(p, carriers.axis);
    ContactGeometry g = no_contact();
    bool is_near = !(query.separation > max_separation);
    if (any_lane(is_near)) {
        uint axis = axis_of_contact(p, query, carriers.axis);
        bool is_at_face = is_near && axis < 6u;
        if (any_lane(is_at_face)) g = choose_active(is_at_face, contact_at_face(p, axis, carriers, max_separation), g);
        // Just before the boxes touch a face that stands for edges may have no point.
        bool is_at_edges = is_near && query.axis >= 6u && g.count == 0u;
        if (any_lane(is_at_edges)) g = choose_active(is_at_edges, contact_at_edges(p, query), g);
        g.separation = choose_active(is_near, query.separation, g.separation);
    }
    g.separations[0] = choose(g.count == 0u, query.separation, g.separations[0]);
    return g;
}
