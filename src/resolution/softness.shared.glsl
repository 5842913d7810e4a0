// SPDX-License-Identifier: MIT
// Sub-steps: how many a load asks for, and how soft contacts are in them. docs/solver.md has the derivation.

struct Softness {
    float bias_rate;     // 1/s
    float mass_scale;    // 1 for a rigid row
    float impulse_scale; // 0 for a rigid row
};

// A spring and a damper of angular frequency w and damping ratio z, stepped implicitly over h, which is stable however
// stiff they are. Catto, "Soft Contacts" (2023) and "Solver2D" (2024).
inline Softness soft_row(float w, float z, float h)
{
    precise float a = 2.0f * z + h * w;
    precise float b = h * w * a;
    precise float bias_rate = w * reciprocal(a);
    precise float impulse_scale = reciprocal(1.0f + b);
    precise float mass_scale = b * impulse_scale;
    Softness soft;
    soft.bias_rate = bias_rate;
    soft.mass_scale = mass_scale;
    soft.impulse_scale = impulse_scale;
    return soft;
}

// What a contact needs to know of one of the equal parts of a step.
struct Substep {
    float inv_h; // 1/s
    Softness soft;
    float push_speed; // m/s, of what overlaps, at most
    float let_go;     // how many times faster impulses fall that throw: see let_go_of_thrown in contact.shared.glsl
};

// How many times as heavy as the two bodies is what they carry or stop, roughly: the speed that the impulses of the last
// step, or of this one so far, give to both, over one that a light load does not reach. solver.md, Heavy on light.
const float k_per_light_load = 0.125f; // s/m: over 8 m/s

inline float heaviness(float load_speed)
{
    precise float ratio = load_speed * k_per_light_load;
    return clamp_to(ratio, 1.0f, 1.0e6f);
}

// What is heavy is pushed apart more slowly: down to this share of the push speed, as more than one contact may push it.
const float k_least_push_share = 0.166666672f; // a sixth

// Heavier than this is what a light body would throw back. Less is what light bodies carry at rest in a heap, which
// never came to rest where their impulses were taken away.
const float k_throwing = 8.0f;

inline float substep_length(uint substeps, Parameters p)
{
    precise float h = p.dt * reciprocal(float(substeps));
    return h;
}

// A contact's frequency is an eighth of the sub-step rate, the stiffest that does not ring, and at most
// contact_frequency (rad/s); twice that against a body that cannot be pushed. Baumgarte's rows are rigid, with the
// bias rate of equation 3.17. The damping ratio is meant for the mass that swings on the contact, so that it grows with
// the root of that. `load_speed`: see load_speed_so_far in contact.shared.glsl.
inline Substep make_substep(uint substeps, bool against_static, float load_speed, Parameters p)
{
    Substep s;
    float h = substep_length(substeps, p);
    precise float inv_h = p.inv_dt * float(substeps);
    s.inv_h = inv_h;
    if (p.baumgarte > 0.0f) {
        precise float rate = p.baumgarte * inv_h;
        s.soft.bias_rate = rate;
        s.soft.mass_scale = 1.0f;
        s.soft.impulse_scale = 0.0f;
        s.push_speed = p.contact_push_speed;
        s.let_go = 0.0f;
        return s;
    }
    precise float eighth = 0.785398163f * inv_h; // 2 pi / 8
    precise float w = min(eighth, p.contact_frequency) * choose(against_static, 2.0f, 1.0f);
    float heavy = heaviness(load_speed);
    precise float damping_ratio = p.contact_damping_ratio * square_root(heavy);
    s.soft = soft_row(w, damping_ratio, h);
    precise float slower = p.contact_push_speed * max(reciprocal(heavy), k_least_push_share);
    precise float let_go = max(heavy - k_throwing, 0.0f);
    s.let_go = let_go;
    s.push_speed = choose(heavy > 1.0f, slower, p.contact_push_speed);
    return s;
}

// ---- how many ----

// A load of N weights is that of a tower of N boxes. One of 1 m boxes buckles beyond N = 6 n^(2/3) at n sub-steps
// (solver.md), so that n follows N^1.5; the linear part keeps short towers from sinking by more than a centimetre or
// two. Where no more than H contacts above each other carry the load, they are a column of that height, with what it carries
// beside itself on its end: that buckles it 7.84 / (pi^2 / 4) = 3.2 times as easily as its own weight. It sinks as if n followed
// sqrt(H N), and a single contact under a heavy body by N g / (47 n)^2, which is to be less than 2 mm.
const float k_substeps_against_sag = 0.45f;
const float k_substeps_against_overlap = 1.5f;
const float k_substeps_against_buckling = 0.09f;
const float k_end_load = 3.2f; // Timoshenko and Gere, "Theory of Elastic Stability" (1961): of a column's own weight

// More sub-steps are had after so many steps in a row that asked for more, and then no more than the next number in use:
// contacts that become much stiffer while they are deep throw back what has pressed them together.
const uint k_growing = 2000u;    // idle steps count up from here while more are asked for
const uint k_growing_steps = 8u;
// Fewer are had only after so many steps in a row in which half would have done: a change of stiffness shakes what stands,
// which changes the load, and without patience a tower never came to rest.
const uint k_patience = 64u;
// What stands where the caller has put it is given the most until its load is known: with few sub-steps a tower would
// be shaken while the load builds up.
const uint k_trial = 1000u;      // idle steps count up from here in a trial
const uint k_trial_steps = 32u;
const uint k_halving_steps = 8u; // to half of that at a time

// The numbers in use are apart by half or a third, up to the most: least, 1.5 least, 2 least, 3 least, 4 least, ...
inline uint substep_level(uint level, uint least)
{
    uint whole = least << (level / 2u);
    return (level & 1u) == 0u ? whole : whole + whole / 2u;
}

// The next number in use.
inline uint more_substeps(uint substeps, Parameters p)
{
    for (uint level = 0u; level < 16u; level += 1u) {
        uint more = substep_level(level, p.least_substeps);
        if (more > substeps) return min(more, p.most_substeps);
    }
    return p.most_substeps;
}

// The lowest number that is enough for a load, and for the height of what carries it.
inline uint wanted_substeps(float weights, uint height, Parameters p)
{
    precise float high = min(float(height), weights);
    precise float bending = high + k_end_load * (weights - high);
    precise float against_buckling = k_substeps_against_buckling * high * square_root(bending);
    precise float against_sag = k_substeps_against_sag * square_root(high * weights);
    precise float against_overlap = k_substeps_against_overlap * square_root(weights);
    float wanted = max(max(against_sag, against_overlap), against_buckling);
    for (uint level = 0u; level < 16u; level += 1u) {
        uint substeps = substep_level(level, p.least_substeps);
        if (substeps >= p.most_substeps) return p.most_substeps;
        if (float(substeps) >= wanted) return substeps;
    }
    return p.most_substeps;
}

const float k_most_weights = 1.0e6f; // with next to no gravity they would leave the range of a float

// How many weights of the lighter body press a manifold together: both bodies carry that at least. `impulse` is that of
// the whole step.
inline float weights_on(float impulse, float inverse_mass_a, float inverse_mass_b, Parameters p)
{
    precise float weights = impulse * max(inverse_mass_a, inverse_mass_b) * p.inverse_weight;
    return min(weights, k_most_weights);
}

// ---- the mean load ----

// The load is a running mean over the steps. An impact is no load: while a heavy body is stopped by a light one it
// presses with thousands of weights, and overlaps. With many more sub-steps, and so with much stiffer contacts, in the
// next step the overlap would throw it back faster than it came. So a step counts as twice the mean and a little at
// most, and a load that stays is known within a few steps more.
const float k_newest_weight = 0.125f; // share of the newest step
const float k_sudden_weights = 8.0f;  // for these 8 sub-steps are plenty

inline float next_mean_load(float mean, float newest)
{
    precise float counted = min(newest, 2.0f * mean + k_sudden_weights);
    precise float next = mean + k_newest_weight * (counted - mean);
    return next;
}

// ---- the height of what carries a load ----
//
// Contacts tell the body below them what mass presses on them, and how high the column is that they are the foot of. Where a
// body carries three times its own mass and more, what stands below it is part of the highest of these columns; else it is the
// end load of a new one. So the height of a tower is known from the top down, one contact a step. In ToldLoads each body has
// two words: k_told_mass, a sum, and k_told_height, a maximum.

const uint k_unknown_height = 255u; // also of all that are higher

// 16 for a mass like the body's own. No contact needs to tell more than what is enough, and so a sum stays a number.
const uint k_enough_told = 48u;

// `weights`: of the contact, in those of its lighter body.
inline uint told_mass(float weights, float inverse_mass_below, float inverse_mass_above)
{
    precise float own_masses = weights * inverse_mass_below * reciprocal(max(inverse_mass_below, inverse_mass_above));
    return uint(min(16.0f * own_masses, float(k_enough_told)));
}

inline uint height_of_column(uint mass_told, uint height_told)
{
    return mass_told < k_enough_told ? 1u : min(height_told + 1u, k_unknown_height);
}

// Manifold::history: steps in a row in which half the sub-steps would have done, and the height of the column.
inline uint make_history(uint idle_steps, uint height) { return idle_steps | height << 16u; }
inline uint idle_steps_of(uint history) { return history & 0xffffu; }
inline uint height_of(uint history) { return history >> 16u; }
