// SPDX-License-Identifier: MIT
// From the geometry of a contact to a manifold: the material, and the impulses of the last step.
// Needs resolution/contact_frame.shared.glsl and resolution/load.shared.glsl.

// Where two bodies ask for different rules, the lower number wins.
inline float combine(float a, float b, uint rule_a, uint rule_b)
{
    uint rule = min(rule_a, rule_b);
    precise float average = 0.5f * (a + b);
    precise float product = a * b;
    float combined = product;
    if (rule == k_combine_average) combined = average;
    if (rule == k_combine_minimum) combined = min(a, b);
    if (rule == k_combine_maximum) combined = max(a, b);
    return combined;
}

inline float combine_friction(BodyProperties a, BodyProperties b)
{
    return combine(a.friction, b.friction, a.combine & 255u, b.combine & 255u);
}

inline float combine_restitution(BodyProperties a, BodyProperties b)
{
    return combine(a.restitution, b.restitution, a.combine >> 8, b.combine >> 8);
}

// ---- sensors: they report what they touch, and push nothing ----

inline bool is_sensed(BodyShape a, BodyShape b) { return is_sensor(a) || is_sensor(b); }

// Sensors do not see each other, and nothing is seen where neither body moves.
inline bool can_meet(BodyShape a, BodyShape b)
{
    return !(is_sensor(a) && is_sensor(b)) && (is_mover(a) || is_mover(b));
}

// A manifold that the solver leaves alone.
inline Manifold make_sensed(Manifold manifold)
{
    Manifold sensed = manifold;
    sensed.colour = k_inactive_colour;
    sensed.tangent_impulse_1 = 0.0f;
    sensed.tangent_impulse_2 = 0.0f;
    sensed.twist_impulse = 0.0f;
    sensed.weights = 0.0f;
    sensed.lasting_weights = 0.0f;
    sensed.demand = 0u;
    return sensed;
}

// ---- warm start: what the last step's points pass on ----

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

// A point of the new manifold.
inline ManifoldPoint make_point(vec3 anchor, uint feature)
{
    ManifoldPoint point;
    point.anchor = anchor;
    point.feature_id = feature;
    return point;
}

// Of all points of the new manifold.
inline Separations make_separations(ContactGeometry g)
{
    Separations separations;
    separations.separation =
        vec4(choose(0u < g.count, g.separations[0], 0.0f), choose(1u < g.count, g.separations[1], 0.0f),
             choose(2u < g.count, g.separations[2], 0.0f), choose(3u < g.count, g.separations[3], 0.0f));
    separations.shift = g.shift;
    separations.way = 0.0f;
    return separations;
}

// For bodies that the caller has just put together: the load is not known yet. Without gravity none builds up.
inline Manifold begin_trial(Manifold manifold, Parameters p)
{
    if (dot3(p.gravity, p.gravity) != 0.0f) manifold.demand = make_demand(p.most_substeps, k_trial, 0u, k_unknown_height);
    return manifold;
}

inline Manifold make_manifold(Pair pair, ContactGeometry g, BodyProperties a, BodyProperties b)
{
    Manifold manifold;
    manifold.body_a = pair.body_a;
    manifold.body_b = pair.body_b;
    manifold.point_count = g.count;
    manifold.colour = k_no_colour;
    manifold.normal = g.normal;
    manifold.axis = g.axis;
    manifold.friction = combine_friction(a, b);
    manifold.restitution = combine_restitution(a, b);
    manifold.tangent_impulse_1 = 0.0f;
    manifold.tangent_impulse_2 = 0.0f;
    manifold.twist_impulse = 0.0f;
    manifold.weights = 0.0f;
    manifold.lasting_weights = 0.0f;
    manifold.demand = 0u;
    return manifold;
}

// Of two bodies that are apart, by `gap` at least (m); 0: it is not known.
inline Manifold no_manifold(Pair pair, float gap)
{
    Manifold manifold;
    manifold.body_a = pair.body_a;
    manifold.body_b = pair.body_b;
    manifold.point_count = 0u;
    manifold.colour = k_no_colour;
    manifold.normal = vec3(0.0f, 0.0f, 0.0f);
    manifold.axis = 0u;
    manifold.friction = 0.0f;
    manifold.restitution = 0.0f;
    manifold.tangent_impulse_1 = 0.0f;
    manifold.tangent_impulse_2 = 0.0f;
    manifold.twist_impulse = 0.0f;
    manifold.weights = gap;
    manifold.lasting_weights = 0.0f;
    manifold.demand = 0u;
    return manifold;
}

// Gives a new manifold the colour, the friction and the load of the last step's. Friction is carried as a vector: the
// tangents of two normals that are nearly the same may lie far apart.
inline Manifold carry_over(Manifold manifold, Manifold old, Parameters p)
{
    manifold.colour = choose(old.colour == k_inactive_colour, k_no_colour, old.colour); // it was a sensor's
    Axes frame = contact_frame(manifold.normal);
    Axes old_frame = contact_frame(old.normal);
    precise vec3 sideways = old_frame.x * old.tangent_impulse_1 + old_frame.y * old.tangent_impulse_2;
    manifold.tangent_impulse_1 = dot3(sideways, frame.x);
    manifold.tangent_impulse_2 = dot3(sideways, frame.y);
    manifold.twist_impulse = old.twist_impulse;
    manifold.weights = old.weights;
    manifold.lasting_weights = old.lasting_weights;
    uint substeps = min(substeps_of(old.demand), p.most_substeps); // which the caller may have lowered
    manifold.demand = make_demand(substeps, idle_steps_of(old.demand), foot_rate_of(old.demand), height_of(old.demand));
    return manifold;
}
