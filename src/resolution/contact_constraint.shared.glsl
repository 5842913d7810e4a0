// SPDX-License-Identifier: MIT
// From a manifold to the solver's record of it, and back.
// Needs resolution/manifold_rows.shared.glsl, contact_counts.shared.glsl, hub.shared.glsl, softness.shared.glsl,
// load.shared.glsl, multirate.shared.glsl and island.shared.glsl.

// ---- from a manifold to a constraint ----

// Of both bodies. In the other colours a hub is a body as others are.
inline uint traits_of_constraint(BodyInertia a, BodyInertia b, uint colour)
{
    uint mask = choose(is_hub_colour(colour), k_trait_hub, 0u) | k_trait_movable | k_trait_round | k_trait_asleep;
    bool is_of_hub = ((a.traits | b.traits) & k_trait_hub) != 0u;
    uint whole_hub = choose(is_of_hub && colour < k_first_hub_colour, k_trait_whole_hub, 0u);
    return (a.traits & mask) | ((b.traits & mask) << k_traits_of_b) | whole_hub;
}

// The sub-steps of a contact between two bodies, and its rate. Of one that is not pushed the number does not count; where
// both are, it is the same but in a multirate island.
struct ContactRate {
    uint substeps;
    uint trait;
};

inline ContactRate find_rate(uint demand, BodyInertia a, BodyInertia b, Parameters p)
{
    bool pushes_a = is_pushed(a.traits);
    bool pushes_b = is_pushed(b.traits);
    ContactRate rate;
    rate.substeps = max(max(choose(pushes_a, a.substeps, 1u), choose(pushes_b, b.substeps, 1u)), 1u);
    rate.trait = 0u;
    uint its_traits = choose(pushes_a, a.traits, b.traits);
    bool multirate = is_multirate(its_traits);
    if (!any_lane(multirate)) return rate;
    uint ticks = choose(pushes_a, ticks_of(a.substeps, a.traits), ticks_of(b.substeps, b.traits));
    uint slower = min(choose(pushes_a, a.substeps, ticks), choose(pushes_b, b.substeps, ticks));
    bool has_tall = (its_traits & k_trait_of_tall) != 0u;
    uint own = min(multirate_substeps(substeps_of(demand), foot_rate_of(demand), has_tall, p), slower);
    rate.substeps = choose_active(multirate, own, rate.substeps);
    rate.trait = choose_active(multirate, slowness_trait(ticks, own) | (its_traits & k_trait_of_tall), 0u);
    return rate;
}

// Impulses are kept for a whole step, and accumulated in a sub-step. `order`: see contact_counts.shared.glsl.
inline ContactConstraint begin_constraint(Manifold manifold, uint manifold_index, uint colour, uint order, float hub_share,
                                          float inverse_mass_a, float inverse_mass_b, BodyInertia inertia_a,
                                          BodyInertia inertia_b, Parameters p)
{
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    vec4 no_points = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    uint traits = traits_of_constraint(inertia_a, inertia_b, colour);
    ContactRate rate = find_rate(manifold.demand, inertia_a, inertia_b, p);
    ContactConstraint c;
    c.body_a = manifold.body_a;
    c.body_b = manifold.body_b;
    c.manifold = manifold_index;
    c.counts = manifold.point_count | order | rate.substeps << k_contact_substeps;
    c.normal = manifold.normal;
    c.friction = manifold.friction;
    c.centre_a = none;
    c.restitution = manifold.restitution;
    c.centre_b = none;
    c.inverse_mass_a = inverse_mass_a;
    c.gap = none;
    c.traits = traits | rate.trait;
    c.friction_mass = none;
    c.inverse_mass_b = inverse_mass_b;
    c.x = no_points;
    c.y = no_points;
    c.lever = no_points;
    c.base_separation = no_points;
    c.normal_mass = no_points;
    precise vec3 friction_impulse =
        vec3(manifold.tangent_impulse_1, manifold.tangent_impulse_2, manifold.twist_impulse) *
        reciprocal(float(rate.substeps));
    c.friction_impulse = friction_impulse;
    c.hub_share = hub_share;
    c.slip = none;
    c.load_speed = 0.0f;
    c.normal_impulse = no_points;
    c.total_impulse = no_points;
    return c;
}

// `offset`: at the meeting.
inline ContactConstraint add_to_centre(ContactConstraint c, vec3 anchor, vec3 offset)
{
    precise float share = reciprocal(float(point_count_of(c.counts)));
    precise vec3 anchor_b = anchor - offset;
    c.centre_a = add_scaled(c.centre_a, anchor, share);
    c.centre_b = add_scaled(c.centre_b, anchor_b, share);
    return c;
}

inline ContactConstraint end_centre(ContactConstraint c, vec3 position_a, vec3 position_b)
{
    precise vec3 gap = (position_b - position_a) + (c.centre_b - c.centre_a);
    c.gap = gap;
    return c;
}

// Point i of the manifold, which starts from `normal_impulse`. `r`: of the meeting.
inline ContactConstraint add_point(ContactConstraint c, int i, vec3 anchor, float separation, float normal_impulse, Meeting m,
                                   NormalResponse r)
{
    precise vec3 arm = anchor - c.centre_a;
    precise vec3 apart = c.centre_b - c.centre_a;
    precise float base = separation - dot3(apart, c.normal);
    precise float impulse = normal_impulse * reciprocal(float(substeps_of_contact(c.counts)));
    float x = dot3(arm, m.frame.x);
    float y = dot3(arm, m.frame.y);
    precise float square = x * x + y * y;
    c.x[i] = x;
    c.y[i] = y;
    c.lever[i] = square_root(square);
    c.base_separation[i] = base;
    c.normal_mass[i] = point_mass(r, x, y);
    c.normal_impulse[i] = impulse;
    precise float load_speed = c.load_speed + normal_impulse * m.inverse_masses;
    c.load_speed = load_speed;
    return c;
}

// After all points, `force` being that of the load that lasts: see lift_of.
inline vec4 lifted_separation(vec4 base_separation, vec4 normal_mass, float force, uint substeps, uint traits, Parameters p)
{
    float lift = lift_of(force, sum4(normal_mass), substeps, is_against_static(traits), p);
    precise vec4 separation = base_separation - lift;
    return separation;
}

// ---- from a constraint back to its manifold ----

// What a point passes on: the last sub-step's impulse, taken for all of them. One that was hit in the last sub-steps
// alone must not be pushed as hard in all of the next step: then it is the sum.
inline float impulse_of_step(float normal_impulse, float total_impulse, uint substeps)
{
    precise float lasting = normal_impulse * float(substeps);
    precise float twice = 2.0f * total_impulse;
    return max(lasting > twice ? total_impulse : lasting, 0.0f);
}

// What becomes of Manifold::colour.
inline uint colour_of_step(uint key, uint its_traits)
{
    uint colour = colour_of_key(key);
    return (its_traits & k_trait_whole_hub) != 0u ? colour | k_whole_hub : colour;
}

// Of the whole step, once its impulses are stored. `hits`: the sum of the step's.
inline vec4 with_hits(vec4 total_impulse, vec4 hits)
{
    precise vec4 sum = total_impulse + hits;
    return sum;
}

// ---- the load ----

// Which of two bodies is below, either where the normal is level, and whether it carries the other as a storey of a column.
struct Standing {
    bool b_below;
    bool is_storey;
};

// What leans more than 37 degrees from the plumb line, or on something whose centre is higher, is no storey: in a heap bodies
// are each below the other by such contacts, and columns grew without end. The arguments are the constraint's.
inline Standing find_standing(vec3 normal, vec3 centre_a, vec3 centre_b, vec3 gap, Parameters p)
{
    precise vec3 between = (centre_a - centre_b) + gap; // from A's centre to B's
    float fall = dot3(normal, p.gravity);
    precise float steepness = fall * p.inverse_weight * p.dt; // the cosine of the angle
    precise float agreement = fall * dot3(between, p.gravity);
    Standing standing;
    standing.b_below = fall > 0.0f;
    standing.is_storey = steepness * steepness >= 0.64f && agreement > 0.0f;
    return standing;
}

inline uint body_above(Standing standing, uint body_a, uint body_b) { return choose(standing.b_below, body_a, body_b); }
inline uint body_below(Standing standing, uint body_a, uint body_b) { return choose(standing.b_below, body_b, body_a); }

// What a manifold tells the body below it, see load.shared.glsl.
struct LoadBelow {
    uint body;
    uint mass; // 0: it tells nothing, as to what cannot be pushed
};

inline LoadBelow load_below(Manifold manifold, Standing standing, float inverse_mass_a, float inverse_mass_b)
{
    float inverse_mass_below = choose(standing.b_below, inverse_mass_b, inverse_mass_a);
    float inverse_mass_above = choose(standing.b_below, inverse_mass_a, inverse_mass_b);
    uint mass = told_mass(manifold.weights, inverse_mass_below, inverse_mass_above);
    LoadBelow load;
    load.body = body_below(standing, manifold.body_a, manifold.body_b);
    load.mass = choose(inverse_mass_below > 0.0f && standing.is_storey, mass, 0u);
    return load;
}

// What a manifold tells the body above it, see multirate.shared.glsl.
struct ToldFoot {
    uint body;
    uint rate; // 0: it tells nothing
};

inline ToldFoot told_foot(Manifold manifold, Standing standing)
{
    ToldFoot foot;
    foot.body = body_above(standing, manifold.body_a, manifold.body_b);
    foot.rate = choose(standing.is_storey, foot_rate_of(manifold.demand), 0u);
    return foot;
}

// Of a manifold with this demand. `told`: what the body below has been told, which counts where that carries enough to be part of
// the column, `mass` being its k_told_mass.
inline uint foot_rate(uint demand, Standing standing, uint told, uint mass, Parameters p)
{
    bool had_rate = foot_rate_of(demand) > 0u;
    uint of_column = choose(standing.is_storey && mass >= choose(had_rate, k_enough_to_stay, k_enough_to_join), told, 0u);
    bool is_tall = height_of(demand) >= choose(had_rate, k_height_to_stay, k_tall_height);
    return max(of_column, choose(is_tall, 1u + doublings_for(substeps_of(demand), p.least_substeps, p), 0u));
}

// Of a manifold with this load. What the body above has been told: see load.shared.glsl. Without gravity nothing says what
// stands on what, and the load alone counts.
inline uint column_height(Standing standing, float weights, float inverse_mass_a, float inverse_mass_b, uint mass_told,
                          uint height_told, Parameters p)
{
    if (dot3(p.gravity, p.gravity) == 0.0f) return k_unknown_height;
    float inverse_mass_above = standing.b_below ? inverse_mass_a : inverse_mass_b;
    float inverse_mass_below = standing.b_below ? inverse_mass_b : inverse_mass_a;
    uint carried = told_mass(weights, inverse_mass_above, inverse_mass_below);
    return standing.is_storey ? height_of_column(mass_told, height_told, carried) : 1u;
}

// The sub-steps that a load asks for in the next step. `height`: of the column that carries it.
inline Manifold follow_load(Manifold manifold, float weights, float yielding, uint height, bool against_static, uint least,
                            Parameters p)
{
    float mean = next_mean_load(manifold.weights, weights);
    uint substeps = substeps_of(manifold.demand);
    uint idle_steps = idle_steps_of(manifold.demand);
    bool grows = idle_steps >= k_growing;
    bool on_trial = is_on_trial(manifold.demand);
    if (on_trial) height = k_unknown_height;
    float needed = needed_substeps(mean, yielding, height, against_static);
    uint wanted = substeps_for(needed, least, p);
    bool half_would_do = on_trial || 2u * wanted <= substeps;
    uint fewer = half_would_do ? max(wanted, substeps / 2u) : fewer_substeps(substeps, least);
    precise float with_some_to_spare = k_to_spare * needed;
    bool idle = half_would_do || (fewer < substeps && with_some_to_spare <= float(fewer));
    if (wanted > substeps) {
        idle_steps = grows ? idle_steps + 1u : k_growing + 1u;
        if (idle_steps == k_growing + k_growing_steps) {
            substeps = more_substeps(substeps, least, p);
            idle_steps = 0u;
        }
    } else {
        uint patience = on_trial ? k_trial + k_trial_steps : k_patience;
        idle_steps = !idle ? 0u : grows ? 1u : idle_steps + 1u;
        if (idle_steps >= patience) {
            substeps = fewer;
            idle_steps = substeps > wanted ? patience - k_halving_steps : 0u;
        }
    }
    manifold.weights = mean;
    manifold.lasting_weights = next_lasting_load(manifold.lasting_weights, mean, on_trial);
    manifold.demand = make_demand(substeps, idle_steps, foot_rate_of(manifold.demand), height);
    return manifold;
}

// See needed_substeps. Of the point that gives way most, which is all that counts where a contact has sub-steps of its own: on
// a corner the effective mass is a quarter of a face's. A whole island would have many for few such contacts.
inline float yielding_of(vec4 normal_impulse, vec4 normal_mass, float inverse_mass_of_lighter)
{
    float most = 0.0f;
    for (int i = 0; i < 4; ++i) {
        precise float way = normal_impulse[i] * reciprocal(normal_mass[i]);
        if (normal_mass[i] > 0.0f) most = max(most, way);
    }
    precise float on_a_face = 2.0f * inverse_mass_of_lighter * sum4(normal_impulse);
    precise float yielding = most * reciprocal(on_a_face);
    return on_a_face > 0.0f ? max(yielding, 1.0f) : 1.0f;
}

// Impulses of the whole step, and what follows from their load. `mass_told`, `height_told`: of the body above, see column_height;
// `mass_below`, `foot_told`: of the one below, see foot_rate.
inline Manifold finish_manifold(Manifold manifold, ContactConstraint c, Standing standing, vec4 normal_impulse, uint mass_told,
                                uint height_told, uint mass_below, uint foot_told, Parameters p)
{
    precise float whole = float(substeps_of_contact(c.counts));
    precise vec3 friction = c.friction_impulse * whole;
    manifold.tangent_impulse_1 = friction.x;
    manifold.tangent_impulse_2 = friction.y;
    manifold.twist_impulse = friction.z;
    float weights = weights_on(sum4(normal_impulse), c.inverse_mass_a, c.inverse_mass_b, p);
    uint height = column_height(standing, manifold.weights, c.inverse_mass_a, c.inverse_mass_b, mass_told, height_told, p);
    float yielding = 1.0f;
    uint least = p.least_substeps;
    if (is_multirate(c.traits)) {
        yielding = yielding_of(normal_impulse, c.normal_mass, max(c.inverse_mass_a, c.inverse_mass_b));
        least = fewest_in_island((c.traits & k_trait_of_tall) != 0u, p);
    }
    manifold = follow_load(manifold, weights, yielding, height, is_against_static(c.traits), least, p);
    uint demand = manifold.demand;
    uint rate = foot_rate(demand, standing, foot_told, mass_below, p);
    manifold.demand = make_demand(substeps_of(demand), idle_steps_of(demand), rate, height_of(demand));
    return manifold;
}
