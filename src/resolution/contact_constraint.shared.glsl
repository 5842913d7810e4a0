// SPDX-License-Identifier: MIT
// From a manifold to the solver's record of it, and back.
// Needs resolution/manifold_rows.shared.glsl, hub.shared.glsl, softness.shared.glsl and island.shared.glsl.

// Whether a pair is one of those that a launch is for.
inline bool is_among(uint pair, uint first, uint count) { return pair >= first && pair - first < count; }

// ---- from a manifold to a constraint ----

// Of both bodies. In the other colours a hub is a body as others are.
inline uint traits_of_constraint(BodyInertia a, BodyInertia b, uint colour)
{
    uint mask = choose(is_hub_colour(colour), k_trait_hub, 0u) | k_trait_movable | k_trait_round;
    bool is_of_hub = ((a.traits | b.traits) & k_trait_hub) != 0u;
    uint whole_hub = choose(is_of_hub && colour < k_first_hub_colour, k_trait_whole_hub, 0u);
    return (a.traits & mask) | ((b.traits & mask) << k_traits_of_b) | whole_hub;
}

// Impulses are kept for a whole step, and accumulated in a sub-step. Of bodies in different numbers of sub-steps, one
// cannot be pushed: the other's number holds.
inline ContactConstraint begin_constraint(Manifold manifold, uint manifold_index, uint colour, float hub_share,
                                          float inverse_mass_a, float inverse_mass_b, BodyInertia inertia_a,
                                          BodyInertia inertia_b)
{
    bool pushes_a = (inertia_a.traits & k_trait_movable) != 0u;
    bool pushes_b = (inertia_b.traits & k_trait_movable) != 0u;
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    vec4 no_points = vec4(0.0f, 0.0f, 0.0f, 0.0f);
    uint traits = traits_of_constraint(inertia_a, inertia_b, colour);
    precise float inverse_masses = share_inverse_mass(inverse_mass_a, hub_share, traits) +
                                   share_inverse_mass(inverse_mass_b, hub_share, traits >> k_traits_of_b);
    ContactConstraint c;
    c.body_a = manifold.body_a;
    c.body_b = manifold.body_b;
    c.manifold = manifold_index;
    c.point_count = manifold.point_count;
    c.normal = manifold.normal;
    c.friction = manifold.friction;
    c.centre_a = none;
    c.restitution = manifold.restitution;
    c.centre_b = none;
    c.inverse_masses = inverse_masses;
    c.gap = none;
    c.traits = traits;
    c.friction_mass = none;
    c.substeps =
        max(max(choose(pushes_a, inertia_a.substeps, 1u), choose(pushes_b, inertia_b.substeps, 1u)), 1u);
    c.x = no_points;
    c.y = no_points;
    c.lever = no_points;
    c.base_separation = no_points;
    c.normal_mass = no_points;
    precise vec3 friction_impulse =
        vec3(manifold.tangent_impulse_1, manifold.tangent_impulse_2, manifold.twist_impulse) *
        reciprocal(float(c.substeps));
    c.friction_impulse = friction_impulse;
    c.hub_share = hub_share;
    c.moment = none;
    c.load_speed = 0.0f;
    c.normal_impulse = no_points;
    c.total_impulse = no_points;
    c.hit_impulse = no_points;
    return c;
}

inline ContactConstraint add_to_centre(ContactConstraint c, ManifoldPoint point)
{
    precise float share = reciprocal(float(c.point_count));
    c.centre_a = add_scaled(c.centre_a, point.anchor_a, share);
    c.centre_b = add_scaled(c.centre_b, point.anchor_b, share);
    return c;
}

inline ContactConstraint end_centre(ContactConstraint c, vec3 position_a, vec3 position_b)
{
    precise vec3 gap = (position_b - position_a) + (c.centre_b - c.centre_a);
    c.gap = gap;
    return c;
}

// Point i of the manifold. `r`: of the meeting.
inline ContactConstraint add_point(ContactConstraint c, int i, ManifoldPoint point, Meeting m, NormalResponse r)
{
    precise vec3 arm = point.anchor_a - c.centre_a;
    precise vec3 apart = c.centre_b - c.centre_a;
    precise float base = point.separation - dot3(apart, c.normal);
    precise float impulse = point.normal_impulse * reciprocal(float(c.substeps));
    float x = dot3(arm, m.frame.x);
    float y = dot3(arm, m.frame.y);
    precise float square = x * x + y * y;
    c.x[i] = x;
    c.y[i] = y;
    c.lever[i] = square_root(square);
    c.base_separation[i] = base;
    c.normal_mass[i] = point_mass(r, x, y);
    c.normal_impulse[i] = impulse;
    precise float load_speed = c.load_speed + point.normal_impulse * c.inverse_masses;
    c.load_speed = load_speed;
    return c;
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

// ---- the load ----

// Where the normal is level either may be.
inline bool is_b_below(Manifold manifold, Parameters p) { return dot3(manifold.normal, p.gravity) > 0.0f; }

inline uint body_above(Manifold manifold, Parameters p)
{
    return is_b_below(manifold, p) ? manifold.body_a : manifold.body_b;
}

// What a manifold tells the body below it, see softness.shared.glsl.
struct LoadBelow {
    uint body;
    uint mass; // 0: it tells nothing, as to what cannot be pushed
};

inline LoadBelow load_below(Manifold manifold, float inverse_mass_a, float inverse_mass_b, Parameters p)
{
    bool b_below = is_b_below(manifold, p);
    float inverse_mass_below = choose(b_below, inverse_mass_b, inverse_mass_a);
    float inverse_mass_above = choose(b_below, inverse_mass_a, inverse_mass_b);
    uint mass = told_mass(manifold.weights, inverse_mass_below, inverse_mass_above);
    LoadBelow load;
    load.body = choose(b_below, manifold.body_b, manifold.body_a);
    load.mass = choose(inverse_mass_below > 0.0f, mass, 0u);
    return load;
}

// The sub-steps that a load asks for in the next step. `height`: of the column that carries it.
inline Manifold follow_load(Manifold manifold, float weights, uint height, Parameters p)
{
    float mean = next_mean_load(manifold.weights, weights);
    uint idle_steps = idle_steps_of(manifold.history);
    bool grows = idle_steps >= k_growing;
    bool on_trial = idle_steps >= k_trial && !grows;
    if (on_trial) height = k_unknown_height;
    uint wanted = wanted_substeps(mean, height, p);
    bool idle = on_trial || 2u * wanted <= manifold.substeps;
    if (wanted > manifold.substeps) {
        idle_steps = grows ? idle_steps + 1u : k_growing + 1u;
        if (idle_steps == k_growing + k_growing_steps) {
            manifold.substeps = more_substeps(manifold.substeps, p);
            idle_steps = 0u;
        }
    } else {
        uint patience = on_trial ? k_trial + k_trial_steps : k_patience;
        idle_steps = !idle ? 0u : grows ? 1u : idle_steps + 1u;
        if (idle_steps >= patience) {
            manifold.substeps = max(wanted, manifold.substeps / 2u);
            idle_steps = manifold.substeps > wanted ? patience - k_halving_steps : 0u;
        }
    }
    manifold.weights = mean;
    manifold.history = make_history(idle_steps, height);
    return manifold;
}

// Impulses of the whole step, and what follows from their load. `height`: of the column that carries it.
inline Manifold finish_manifold(Manifold manifold, ContactConstraint c, vec4 normal_impulse, float inverse_mass_a,
                               float inverse_mass_b, uint height, Parameters p)
{
    precise float whole = float(c.substeps);
    precise vec3 friction = c.friction_impulse * whole;
    manifold.tangent_impulse_1 = friction.x;
    manifold.tangent_impulse_2 = friction.y;
    manifold.twist_impulse = friction.z;
    float weights = weights_on(sum4(normal_impulse), inverse_mass_a, inverse_mass_b, p);
    return follow_load(manifold, weights, height, p);
}
