// SPDX-License-Identifier: MIT
// Multirate islands: sub-steps where they are needed. docs/solver.md has the reasons.
//
// In a very large island each contact has the sub-steps that it asks for, in a tall column at least those that the column's foot
// asks for, and a body those of its contact with most. Their numbers are the fewest, doubled some times, so that each sub-step
// of few begins with one of many. A step has as many ticks as the most sub-steps: of what is 2^r times slower every 2^r-th begins a
// sub-step. What a contact changes about a faster body is spread evenly over that body's sub-steps until the contact's next one.

const uint k_multirate = 0x10000u; // in Substeps, beside a number: the body's island is multirate
const uint k_multirate_tall = 0x20000u; // and it has a tall column
const uint k_slowness_shift = 16u; // in traits, from this bit on: 1 + r; 0 where the island is not multirate

inline uint number_of_substeps(uint word) { return word & (k_multirate - 1u); }

// How often `least` is doubled for as many as that, or for the most that there may be.
inline uint doublings_for(uint number, uint least, Parameters p)
{
    uint doublings = 0u;
    for (uint i = 0u; any_lane(i < k_most_doublings); i += 1u) {
        bool too_few = (least << doublings) < number && (least << (doublings + 1u)) <= p.most_substeps;
        doublings += choose(too_few, 1u, 0u);
    }
    return doublings;
}

// Of the fewest and their doubles up to the most, the lowest number that is enough.
inline uint doubled_substeps(uint number, Parameters p)
{
    return p.fewest_substeps << doublings_for(number, p.fewest_substeps, p);
}

// ---- tall columns ----
//
// A tall column has to be as stiff above as it is at its foot, where it carries most: with what each contact of it asks for by its
// own load a tower of 50 boxes fell that has 32 sub-steps as an island of its own. So contacts of a tall column tell the body above
// them what its foot asks for, one contact a step. A foot rate is 1 + r where that is the least number of an island doubled r times; 0: the
// contact is in no tall column.
//
// Other numbers shake what stands, by which heights and loads change a little: so a contact that has a rate keeps it below what
// it takes to get one. Without that towers of 23 boxes shook each other's rates for ever. Nor does a limit lie at whole masses,
// which is what boxes of one size carry.

const uint k_tall_height = 20u;    // contacts; heaps have no columns of this height
const uint k_height_to_stay = 15u;
const uint k_enough_to_join = 40u; // of k_told_mass, in parts of the body's own: 2.5
const uint k_enough_to_stay = 24u; // 1.5

// Contacts of an island with a tall column have the least number of other islands: what stands is soft enough with that.
inline uint fewest_in_island(bool has_tall, Parameters p) { return choose(has_tall, p.least_substeps, p.fewest_substeps); }

// The sub-steps of what asks for a number, with such a foot rate.
inline uint multirate_substeps(uint number, uint rate, bool has_tall, Parameters p)
{
    uint of_foot = choose(rate > 0u, p.least_substeps << (max(rate, 1u) - 1u), fewest_in_island(has_tall, p));
    return max(doubled_substeps(number, p), min(of_foot, p.most_substeps)); // which the caller may have lowered
}

inline bool is_multirate(uint traits) { return (traits >> k_slowness_shift) != 0u; }

// r: a tick in 2^r begins a sub-step.
inline uint slowness(uint traits) { return max(traits >> k_slowness_shift, 1u) - 1u; }

// Of `substeps` in a step of `ticks`.
inline uint slowness_at(uint ticks, uint substeps)
{
    uint r = 0u;
    for (uint i = 0u; any_lane(i < k_most_doublings); i += 1u)
        r += choose((substeps << i) < ticks, 1u, 0u);
    return r;
}

inline uint slowness_trait(uint ticks, uint substeps) { return (1u + slowness_at(ticks, substeps)) << k_slowness_shift; }

inline uint ticks_of(uint substeps, uint traits) { return substeps << slowness(traits); }

// Which of its sub-steps a tick begins; k_none: none.
inline uint substep_at(uint tick, uint traits)
{
    uint r = slowness(traits);
    uint substep = tick >> r;
    return choose((substep << r) == tick, substep, k_none);
}

// Of what a contact changes about a body in its own sub-step, the part that this one of the body's has. A power of two.
inline float part_of_change(uint traits, uint traits_of_body)
{
    uint halvings = slowness(traits) - min(slowness(traits_of_body), slowness(traits));
    return uintBitsToFloat((127u - halvings) << 23u);
}

inline BodyVelocity change_in_part(BodyVelocity before, BodyVelocity after, float part)
{
    precise vec3 linear = before.linear + (after.linear - before.linear) * part;
    precise vec3 angular = before.angular + (after.angular - before.angular) * part;
    after.linear = choose(part < 1.0f, linear, after.linear);
    after.angular = choose(part < 1.0f, angular, after.angular);
    return after;
}
