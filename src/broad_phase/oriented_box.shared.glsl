// SPDX-License-Identifier: MIT
// Boxes that last from one search for pairs to the next, and pairs that their faces keep apart.
// Needs broad_phase/aabb.shared.glsl.
//
// The search for pairs sees boxes that reach further than contacts do, by a skin. While every body stays within the one that
// the search had of it, its pairs are all that there can be, and no search is made (Verlet 1967). What stands moves by some
// micrometres a step; a thicker skin would make pairs of bricks with mortar between them.
const float k_skin = 2.5e-3f; // m

inline OrientedBox with_skin(OrientedBox box)
{
    precise float margin = box.margin + k_skin;
    box.margin = margin;
    return box;
}

// Whether no point of a body has got further, with the margin that it has now, than the margin that it had: in any
// direction, so that what kept two bodies apart along one still does. A rotation by the angle a about the centre moves the
// corners by no more than 2 sin(a/2) times their distance from it, and sin(a/2) is the length of the quaternion's vector part.
// What is not there any more meets nobody.
inline bool is_within(OrientedBox inner, OrientedBox outer)
{
    vec4 back = vec4(-outer.rotation.x, -outer.rotation.y, -outer.rotation.z, outer.rotation.w);
    vec4 turn = multiply_quaternions(back, inner.rotation);
    precise vec3 way = inner.centre - outer.centre;
    precise float reach = length3(way) + 2.0f * length3(vec3(turn.x, turn.y, turn.z)) * length3(inner.half_extents);
    precise float margin = inner.margin + reach;
    bool same = inner.type == outer.type && inner.half_extents.x == outer.half_extents.x &&
                inner.half_extents.y == outer.half_extents.y && inner.half_extents.z == outer.half_extents.z;
    return !is_present(shape_of(inner)) || (same && margin <= outer.margin);
}

// ---- two boxes ----

struct BoxPair {
    Axes a;
    Axes b;
    vec3 half_a;
    vec3 half_b;
    vec3 offset; // from A's centre to B's, world
};

inline BoxPair make_box_pair(vec3 centre_a, vec4 rotation_a, vec3 half_a, vec3 centre_b, vec4 rotation_b, vec3 half_b)
{
    precise vec3 offset = centre_b - centre_a;
    BoxPair p;
    p.a = rotation_axes(rotation_a);
    p.b = rotation_axes(rotation_b);
    p.half_a = half_a;
    p.half_b = half_b;
    p.offset = offset;
    return p;
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

// Whether a face of one of two boxes has the other box beyond it, out of reach: then their shapes have no contact, though
// their bounding boxes overlap, as those of turned bricks side by side do.
inline bool faces_part(OrientedBox a, OrientedBox b)
{
    BoxPair p = make_box_pair(a.centre, a.rotation, a.half_extents, b.centre, b.rotation, b.half_extents);
    precise float reach = a.margin + b.margin;
    float of_a = max(max(separation_along(p, p.a.x), separation_along(p, p.a.y)), separation_along(p, p.a.z));
    float of_b = max(max(separation_along(p, p.b.x), separation_along(p, p.b.y)), separation_along(p, p.b.z));
    return max(of_a, of_b) > reach;
}
