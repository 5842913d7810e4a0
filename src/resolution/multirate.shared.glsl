// SPDX-License-Identifier: MIT
// Multirate islands: sub-steps where they are needed. docs/solver.md has the reasons.
//
// In a very large island without tall columns each contact has the sub-steps that it asks for, and a body those of its contact
// with most. Their numbers are the least one, doubled some times, so that each sub-step of few begins with one of
// many. A step has as many ticks as the most sub-steps: of what is 2^r times slower every 2^r-th begins a sub-step. What a
// contact changes about a faster body is spread evenly over that body's sub-steps until the contact's next one.

const uint k_multirate = 0x10000u; // in Substeps, beside a number: the body's island is multirate
const uint k_slowness_shift = 16u; // in traits, from this bit on: 1 + r; 0 where the island is not multirate
const uint k_most_doublings = 5u;

inline uint number_of_substeps(uint word) { return word & (k_multirate - 1u); }

// Of the least number and its doubles up to the most, the lowest that is enough.
inline uint doubled_substeps(uint demand, Parameters p)
{
    uint substeps = p.least_substeps;
    for (uint i = 0u; any_lane(i < k_most_doublings); i += 1u) {
        uint twice = 2u * substeps;
        substeps = choose(substeps < demand && twice <= p.most_substeps, twice, substeps);
    }
    return substeps;
}

// Whether a contact of a multirate island has more sub-steps than most. `word`: Substeps of one of its bodies.
inline bool is_fast(uint word, uint demand, Parameters p)
{
    return (word & k_multirate) != 0u && demand > p.least_substeps;
}

inline bool is_multirate(uint traits) { return (traits >> k_slowness_shift) != 0u; }

// r: a tick in 2^r begins a sub-step.
inline uint slowness(uint traits) { return max(traits >> k_slowness_shift, 1u) - 1u; }

// What says so, of `substeps` in a step of `ticks`.
inline uint slowness_trait(uint ticks, uint substeps)
{
    uint trait = 1u;
    for (uint i = 0u; any_lane(i < k_most_doublings); i += 1u)
        trait += choose((substeps << i) < ticks, 1u, 0u);
    return trait << k_slowness_shift;
}

inline uint ticks_of(uint substeps, uint traits) { return substeps << slowness(traits); }

// Which of its sub-steps a tick begins; k_none: none.
inline uint substep_at(uint tick, uint traits)
{
    uint r = slowness(traits);
    uint substep = tick >> r;
    return choose((substep << r) == tick, substep, k_none);
}

// FastContact::rate: the number, and the rate where traits have it.
inline uint rate_of(uint substeps, uint traits) { return substeps | ((traits >> k_slowness_shift) << k_slowness_shift); }

inline bool has_substep(FastContact contact, uint tick)
{
    return substep_at(tick, contact.rate) < number_of_substeps(contact.rate);
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
