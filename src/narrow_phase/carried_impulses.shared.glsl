// SPDX-License-Identifier: MIT
// Warm start: what the points of a pair's last manifold pass on to those of the new one, a pair at a time.
// Needs narrow_phase/contact_geometry.shared.glsl.

// A point without a namesake takes the old point nearest to it, if there is one within this distance (m): feature ids
// flicker when a vertex lies on a side plane, and stacks topple where that costs the impulse.
const float k_anchor_match = 0.04f;

// The points of a pair's last manifold.
struct OldPoints {
    uint axis; // its separating axis
    uint count;
    vec3 anchors[4]; // from A's centre
    uint features[4];
    float impulses[4]; // N s, along the normal
};

inline uint carrying_feature(OldPoints old, uint i)
{
    return choose(i < old.count && old.impulses[i] > 0.0f, old.features[i], k_none);
}

inline Carriers carriers_of(OldPoints old)
{
    Carriers carriers;
    carriers.axis = old.axis;
    carriers.features[0] = carrying_feature(old, 0u);
    carriers.features[1] = carrying_feature(old, 1u);
    carriers.features[2] = carrying_feature(old, 2u);
    carriers.features[3] = carrying_feature(old, 3u);
    return carriers;
}

struct PointMatch {
    uint old_index[4]; // for each new point the old one, or k_none
};

// The first of the old points that are free, a bit each, with this name; k_none: there is none.
inline uint find_namesake(OldPoints old, uint free, uint feature)
{
    uint named = choose(old.features[0] == feature, 1u, 0u) | choose(old.features[1] == feature, 2u, 0u) |
                 choose(old.features[2] == feature, 4u, 0u) | choose(old.features[3] == feature, 8u, 0u);
    named &= free;
    return choose(named == 0u, k_none, uint(findLSB(named)));
}

struct Nearest {
    uint index;
    float square; // m^2, the square of its distance
};

inline Nearest nearer(Nearest best, vec3 anchor, uint index, uint free, vec3 point)
{
    precise vec3 apart = anchor - point;
    float square = dot3(apart, apart);
    if (((free >> index) & 1u) != 0u && square < best.square) {
        best.index = index;
        best.square = square;
    }
    return best;
}

inline uint find_nearest(OldPoints old, uint free, vec3 point)
{
    Nearest best;
    best.index = k_none;
    best.square = k_anchor_match * k_anchor_match;
    best = nearer(best, old.anchors[0], 0u, free, point);
    best = nearer(best, old.anchors[1], 1u, free, point);
    best = nearer(best, old.anchors[2], 2u, free, point);
    best = nearer(best, old.anchors[3], 3u, free, point);
    return best.index;
}

inline uint without(uint free, uint index) { return choose(index == k_none, free, free & ~(1u << (index & 31u))); }

// Feature ids say the same only on the same separating axis.
inline PointMatch match_points(ContactGeometry g, OldPoints old)
{
    PointMatch match;
    match.old_index[0] = match.old_index[1] = match.old_index[2] = match.old_index[3] = k_none;
    uint free = (1u << old.count) - 1u;
    if (g.axis == old.axis) {
        if (0u < g.count) match.old_index[0] = find_namesake(old, free, g.features[0]);
        free = without(free, match.old_index[0]);
        if (1u < g.count) match.old_index[1] = find_namesake(old, free, g.features[1]);
        free = without(free, match.old_index[1]);
        if (2u < g.count) match.old_index[2] = find_namesake(old, free, g.features[2]);
        free = without(free, match.old_index[2]);
        if (3u < g.count) match.old_index[3] = find_namesake(old, free, g.features[3]);
        free = without(free, match.old_index[3]);
    }
    if (0u < g.count && match.old_index[0] == k_none) match.old_index[0] = find_nearest(old, free, g.points[0]);
    free = without(free, match.old_index[0]);
    if (1u < g.count && match.old_index[1] == k_none) match.old_index[1] = find_nearest(old, free, g.points[1]);
    free = without(free, match.old_index[1]);
    if (2u < g.count && match.old_index[2] == k_none) match.old_index[2] = find_nearest(old, free, g.points[2]);
    free = without(free, match.old_index[2]);
    if (3u < g.count && match.old_index[3] == k_none) match.old_index[3] = find_nearest(old, free, g.points[3]);
    return match;
}

inline float impulse_of(OldPoints old, uint i)
{
    return choose(i == 0u, old.impulses[0], choose(i == 1u, old.impulses[1],
                  choose(i == 2u, old.impulses[2], choose(i == 3u, old.impulses[3], 0.0f))));
}

// What each new point starts from.
inline vec4 carry_impulses(ContactGeometry g, OldPoints old)
{
    PointMatch match = match_points(g, old);
    return vec4(impulse_of(old, match.old_index[0]), impulse_of(old, match.old_index[1]),
                impulse_of(old, match.old_index[2]), impulse_of(old, match.old_index[3]));
}
