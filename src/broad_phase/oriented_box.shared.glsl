// SPDX-License-Identifier: MIT
// Boxes that last from one search for pairs to the next, and pairs that their faces keep apart.
// Needs broad_phase/aabb.shared.glsl.
//
// The search for pairs sees boxes that reach further than contacts do, by a skin. While every body stays within the one that
// the search had of it, its pairs are all that there can be, and no search is made (Verlet 1967). What stands moves by some
// micrometres a step; a thicker skin would make pairs of bricks with mortar between them.
const float k_skin = 2.5e-3f; // m

// Of both bodies, where all are searched for, it is more than k_axis_persistence, by which contacts may reach further than margins
// say: docs/decisions/pairs-by-faces.md.
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

inline float reach_along(Axes axes, vec3 half_extents, vec3 direction)
{
    precise float reach = abs(dot3(axes.x, direction)) * half_extents.x + abs(dot3(axes.y, direction)) * half_extents.y +
                          abs(dot3(axes.z, direction)) * half_extents.z;
    return reach;
}

// Separation along a unit direction: distance of the centres less the extents of both boxes.
inline float separation_along(BoxPair p, vec3 direction)
{
    float reach_a = reach_along(p.a, p.half_a, direction);
    float reach_b = reach_along(p.b, p.half_b, direction);
    precise float separation = abs(dot3(p.offset, direction)) - reach_a - reach_b;
    return separation;
}

// The extents of both are added first, so that the answer is the same for B and A, to the bit.
inline bool is_beyond(BoxPair p, vec3 direction, float margins)
{
    precise float reach = reach_along(p.a, p.half_a, direction) + reach_along(p.b, p.half_b, direction);
    precise float limit = reach + margins;
    return abs(dot3(p.offset, direction)) > limit;
}

// Whether a face of one of two boxes has the other box beyond it, out of reach: then their shapes have no contact, though
// their bounding boxes overlap, as those of turned bricks side by side do.
inline bool faces_part(OrientedBox a, OrientedBox b)
{
    BoxPair p = make_box_pair(a.centre, a.rotation, a.half_extents, b.centre, b.rotation, b.half_extents);
    precise float margins = a.margin + b.margin;
    return is_beyond(p, p.a.x, margins) || is_beyond(p, p.a.y, margins) || is_beyond(p, p.a.z, margins) ||
           is_beyond(p, p.b.x, margins) || is_beyond(p, p.b.y, margins) || is_beyond(p, p.b.z, margins);
}
