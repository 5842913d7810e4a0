// SPDX-License-Identifier: MIT
// The load on a manifold, and how many sub-steps it asks for. docs/solver.md has the derivation.

// ---- how many ----

// A load of N weights is that of a tower of N boxes. One of 1 m boxes buckles beyond N = 6 n^(2/3) at n sub-steps
// (solver.md), so that n follows N^1.5. Where no more than H contacts above each other carry the load, they are a
// column of that height, with what it carries beside itself on its end: that buckles it 7.84 / (pi^2 / 4) = 3.2 times
// as easily as its own weight. A single contact under a heavy body sinks by N g / (47 n)^2, which is to be less
// than 4.4 mm before it is lifted.
const float k_substeps_against_overlap = 1.0f;
const float k_substeps_against_buckling = 0.09f;
const float k_end_load = 3.2f; // Timoshenko and Gere, "Theory of Elastic Stability" (1961): of a column's own weight

// More sub-steps are had after so many steps in a row that asked for more, and then no more than the next number in
// use: contacts that become much stiffer while they are deep throw back what has pressed them together.
const uint k_growing = 2000u; // idle steps count up from here while more are asked for
const uint k_growing_steps = 8u;
// Fewer are had only after so many steps in a row in which half would have done, or the next number with something to
// spare: a change of stiffness shakes what stands, which changes the load, and without patience a tower never came to
// rest.
const uint k_patience = 64u;
const float k_to_spare = 1.25f;
// What stands where the caller has put it is given the most until its load is known: with few sub-steps a tower would
// be shaken while the load builds up.
const uint k_trial = 1000u; // idle steps count up from here in a trial
const uint k_trial_steps = 32u;
const uint k_halving_steps = 8u; // to half of that at a time

// The numbers in use are apart by half or a third, up to the most: least, 1.5 least, 2 least, 3 least, 4 least, ...
inline uint substep_level(uint level, uint least)
{
    uint whole = least << (level / 2u);
    return (level & 1u) == 0u ? whole : whole + whole / 2u;
}

// The lowest number in use from `least` on that is at least `number`, and no more than the most.
inline uint substeps_for(float number, uint least, Parameters p)
{
    for (uint level = 0u; level < 16u; level += 1u) {
        uint substeps = substep_level(level, least);
        if (substeps >= p.most_substeps) return p.most_substeps;
        if (float(substeps) >= number) return substeps;
    }
    return p.most_substeps;
}

inline uint more_substeps(uint substeps, uint least, Parameters p)
{
    return substeps_for(float(substeps + 1u), least, p);
}

// The next lower number in use, or the same.
inline uint fewer_substeps(uint substeps, uint least)
{
    uint fewer = min(least, substeps);
    for (uint level = 1u; level < 16u && substep_level(level, least) < substeps; level += 1u)
        fewer = substep_level(level, least);
    return fewer;
}

// How many are enough for a load, and for the height of what carries it. `yielding`: how far the contact gives way to a load,
// as a multiple of what two equal boxes do on a face.
inline float needed_substeps(float weights, float yielding, uint height, bool against_static)
{
    precise float high = min(float(height), weights);
    precise float bending = high + k_end_load * (weights - high);
    precise float against_buckling = k_substeps_against_buckling * high * square_root(bending);
    precise float against_overlap = k_substeps_against_overlap * square_root(weights * yielding);
    float most = max(against_overlap, against_buckling);
    precise float needed = most * choose(against_static, 0.5f, 1.0f); // its frequency is twice as high
    return needed;
}

const float k_most_weights = 1.0e6f; // with next to no gravity they would leave the range of a float

// How many weights of the lighter body press a manifold together: both bodies carry that at least. `impulse` is that of
// the whole step.
inline float weights_on(float impulse, float inverse_mass_a, float inverse_mass_b, Parameters p)
{
    precise float weights = impulse * max(inverse_mass_a, inverse_mass_b) * p.inverse_weight;
    return min(weights, k_most_weights);
}

// N that `weights` are.
inline float force_of(float weights, float inverse_mass_a, float inverse_mass_b, Parameters p)
{
    float inverse_mass = max(inverse_mass_a, inverse_mass_b);
    precise float force = weights * p.inv_dt * reciprocal(inverse_mass * p.inverse_weight);
    return choose(inverse_mass > 0.0f, force, 0.0f);
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

// The load that lasts, for the lift. It is given up at once, and believed slowly, only where the mean has left a band above it:
// a tall structure sways about once a second, and a lift that followed its loads with a delay drove the sway. On trial it is the
// mean: there are most sub-steps then, and next to no lift.
const float k_lasting_weight = 0.0009765625f; // share of the newest mean where that is more: 17 s at 60 steps a second
const float k_lasting_band = 0.75f;           // of the mean

inline float next_lasting_load(float lasting, float mean, bool on_trial)
{
    precise float least = k_lasting_band * mean;
    precise float slowly = lasting + k_lasting_weight * (least - lasting);
    return on_trial ? mean : lasting > mean ? mean : lasting < least ? slowly : lasting;
}

// ---- the height of what carries a load ----
//
// Contacts tell the body below them what mass presses on them, and how high the column is that they are the foot of.
// Where a body carries three times its own mass and more, what stands below it is part of the highest of these columns;
// else it is the end load of a new one. So the height of a tower is known from the top down, one contact a step. What
// buckles a column is its load times the square of its height: where a load joins from the side, as beside a hole in a
// wall, the part above that carries less counts as that much lower. In ToldLoads each body has two words: k_told_mass,
// a sum, and k_told_height, a maximum. Behind those of all each has one more: the highest foot rate that it has been told
// (multirate.shared.glsl).

const uint k_unknown_height = 255u; // also of all that are higher

inline uint told_foot_word(uint body, uint body_count) { return k_told_words * body_count + body; }

const uint k_own_mass = 16u; // of what is told
const uint k_enough_told = 3u * k_own_mass;
const uint k_most_told = 4095u * k_own_mass; // by a contact: so a sum of 65,536 stays a number

// What presses on a contact, in parts of one body's mass. `weights`: of the contact, in those of its lighter body.
inline uint told_mass(float weights, float inverse_mass, float inverse_mass_of_other)
{
    float inverse_mass_of_lighter = max(inverse_mass, inverse_mass_of_other); // 0 of a frozen body on a static one
    float mass_of_lighter = choose(inverse_mass_of_lighter > 0.0f, reciprocal(inverse_mass_of_lighter), 0.0f);
    precise float own_masses = weights * inverse_mass * mass_of_lighter;
    return uint(min(float(k_own_mass) * own_masses, float(k_most_told)));
}

// What the body above has been told, and what a contact below it carries, in parts of that body's mass.
inline uint height_of_column(uint mass_told, uint height_told, uint carried)
{
    if (mass_told < k_enough_told) return 1u;
    precise float from_above = 1.25f * float(min(mass_told, k_most_told)); // what sways is no side load
    precise float share = from_above * reciprocal(max(float(carried) - float(k_own_mass), from_above));
    precise float height = float(height_told) * square_root(share);
    return min(uint(height + 1.5f), k_unknown_height);
}

// Manifold::demand: the sub-steps that a manifold asks for, up to 1,000; for how many steps in a row fewer would have done (with
// k_growing and k_trial, what else it waits for); the rate of the foot below it, see multirate.shared.glsl; and the height of the
// column.
inline uint make_demand(uint substeps, uint idle_steps, uint foot_rate, uint height)
{
    return substeps | idle_steps << 10u | foot_rate << 21u | height << 24u;
}

inline uint substeps_of(uint demand) { return demand & 0x3ffu; }
inline uint idle_steps_of(uint demand) { return (demand >> 10u) & 0x7ffu; }
inline uint foot_rate_of(uint demand) { return (demand >> 21u) & 7u; }
inline uint height_of(uint demand) { return demand >> 24u; }

inline bool is_on_trial(uint demand) { return idle_steps_of(demand) >= k_trial && idle_steps_of(demand) < k_growing; }

// Whether it is known that the manifold stands in a tall column: while a load is not known, nor is a height.
inline bool is_in_tall_column(uint demand) { return foot_rate_of(demand) > 0u && !is_on_trial(demand); }

// Whether the same islands with the same sub-steps follow from both. An island has as many as the contact of it that asks for
// most, `of_island`, and what others ask for makes no difference; but it does where some island of the world may be multirate.
inline bool asks_alike(uint demand, uint other, uint of_island, bool may_be_multirate)
{
    if (may_be_multirate) return substeps_of(demand) == substeps_of(other) && foot_rate_of(demand) == foot_rate_of(other);
    return substeps_of(demand) == substeps_of(other) || max(substeps_of(demand), substeps_of(other)) < of_island;
}
