// SPDX-License-Identifier: MIT
// Boxes that last from one search for pairs to the next, and pairs that their faces keep apart.
// Needs broad_phase/aabb.shared.glsl.
//
// The search for pairs sees boxes that reach further than contacts do, by a skin. While every body stays within the one that
// the search had of it, its pairs are all that there can be, and no search is made (Verlet 1967). What stands moves by some
// micrometres a step; a thicker skin would make pairs of bricks with mortar between them.
const float k_skin = 2.5e-3f; // m

// Of both bodies, where all are searched for, it is more than k_axis_persistence and k_parting, by which contacts may reach further than
// margins say: docs/decisions/pairs-by-faces.md.
const float k_least_skin = 7.5e-4f; // m

// What of the skin is left to the rounding of all that is computed from it (m).
const float k_rounding = 2.5e-4f;

// What moves leaves its box soon in any case, so its way of a step, which is in its margin, counts as a part of the skin. With all of
// it bricks that fall by a millimetre once they are set up were pairs across their mortar: twice as many as else, all with their room.
inline OrientedBox with_skin(OrientedBox box, Parameters p)
{
    precise float at_rest = 0.5f * p.speculative_distance + k_skin;
    precise float moving = box.margin + k_least_skin;
    box.margin = max(at_rest, moving);
    return box;
}

// Whether no point of a body has got further, with the margin that it has now, than the margin that it had: in any direction,
// so that what kept two bodies apart along one still does. What is not there any more meets nobody.
inline bool is_within(OrientedBox inner, OrientedBox outer)
{
    precise vec3 movement = inner.centre - outer.centre;
    vec4 back = vec4(-outer.rotation.x, -outer.rotation.y, -outer.rotation.z, outer.rotation.w);
    float way = way_of(movement, multiply_quaternions(inner.rotation, back), shape_of(inner));
    precise float margin = inner.margin + way + k_rounding;
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

// B in A's axes, which is all that its separation from A depends on.
struct BoxView {
    Axes axes;
    vec3 offset;
};

inline BoxView seen_from_a(BoxPair p)
{
    BoxView b;
    b.axes.x = to_local(p.a, p.b.x);
    b.axes.y = to_local(p.a, p.b.y);
    b.axes.z = to_local(p.a, p.b.z);
    b.offset = to_local(p.a, p.offset);
    return b;
}

// Along the normals of A's and of B's faces: the distance of the centres less the extents of both boxes (m). The nine products of
// the axes serve all of them (Gottschalk, Lin and Manocha, "OBBTree", 1996).
struct FaceSeparations {
    vec3 a;
    vec3 b;
};

// The same for B and A, to the bit.
inline FaceSeparations separate_along_faces(BoxPair p, BoxView b)
{
    vec3 x = abs(b.axes.x);
    vec3 y = abs(b.axes.y);
    vec3 z = abs(b.axes.z);
    precise vec3 of_a = abs(b.offset) - (p.half_a + (x * p.half_b.x + y * p.half_b.y + z * p.half_b.z));
    precise vec3 of_b = abs(to_local(p.b, p.offset)) - (p.half_b + vec3(dot3(x, p.half_a), dot3(y, p.half_a), dot3(z, p.half_a)));
    FaceSeparations separations;
    separations.a = of_a;
    separations.b = of_b;
    return separations;
}

// Whether a face of one of two boxes has the other box beyond it, out of reach: then their shapes have no contact, though
// their bounding boxes overlap, as those of turned bricks side by side do.
inline bool faces_part(OrientedBox a, OrientedBox b)
{
    BoxPair p = make_box_pair(a.centre, a.rotation, a.half_extents, b.centre, b.rotation, b.half_extents);
    FaceSeparations apart = separate_along_faces(p, seen_from_a(p));
    precise float margins = a.margin + b.margin;
    return apart.a.x > margins || apart.a.y > margins || apart.a.z > margins || apart.b.x > margins ||
           apart.b.y > margins || apart.b.z > margins;
}
