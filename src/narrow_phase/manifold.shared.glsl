// SPDX-License-Identifier: MIT
// From the geometry of a contact to a manifold: the material, and what it has of the last step but for the impulses of its points
// (narrow_phase/carried_impulses.shared.glsl).
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

// ---- a new manifold ----

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
