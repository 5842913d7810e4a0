// SPDX-License-Identifier: MIT
// The axis of largest spread, and the order along it (thesis, section 3.2).

inline SpreadSum empty_spread()
{
    SpreadSum sum;
    sum.centre = vec3(0.0f, 0.0f, 0.0f);
    sum.count = 0.0f;
    sum.centre_squared = vec3(0.0f, 0.0f, 0.0f);
    sum.reserved_1 = 0.0f;
    sum.extent = vec3(0.0f, 0.0f, 0.0f);
    sum.reserved_2 = 0.0f;
    return sum;
}

inline SpreadSum spread_of(Aabb box)
{
    SpreadSum sum = empty_spread();
    if (box.lower.x <= box.upper.x && box.movable != 0u) {
        precise vec3 centre = 0.5f * (box.lower + box.upper);
        precise vec3 squared = centre * centre;
        precise vec3 extent = box.upper - box.lower;
        sum.centre = centre;
        sum.count = 1.0f;
        sum.centre_squared = squared;
        sum.extent = extent;
    }
    return sum;
}

inline SpreadSum add_spreads(SpreadSum a, SpreadSum b)
{
    precise vec3 centre = a.centre + b.centre;
    precise float count = a.count + b.count;
    precise vec3 squared = a.centre_squared + b.centre_squared;
    precise vec3 extent = a.extent + b.extent;
    SpreadSum sum = empty_spread();
    sum.centre = centre;
    sum.count = count;
    sum.centre_squared = squared;
    sum.extent = extent;
    return sum;
}

// The axis on which the centres of the movable bodies vary most, and the length from which on a body counts as large: a
// large body would be swept across most of the world, so it is kept out of the sweep and tested against all.
// `body_count`: for the places that the sort will tell, should it find none.
inline SweepAxis choose_sweep_axis(SpreadSum sum, uint body_count)
{
    precise float inverse_count = reciprocal(max(sum.count, 1.0f));
    precise vec3 mean = sum.centre * inverse_count;
    precise vec3 variance = sum.centre_squared * inverse_count - mean * mean;
    precise vec3 extent = sum.extent * inverse_count;
    SweepAxis result;
    result.axis = 0u;
    if (variance.y > variance.x) result.axis = 1u;
    if (variance.z > max(variance.x, variance.y)) result.axis = 2u;
    precise float large = 8.0f * component(extent, result.axis);
    result.large_extent = large;
    result.first_large = body_count;
    result.end = body_count;
    return result;
}

inline bool is_large(Aabb box, SweepAxis sweep)
{
    precise float extent = component(box.upper, sweep.axis) - component(box.lower, sweep.axis);
    return extent > sweep.large_extent;
}

const uint k_large_key = 0xfffffffeu;
const uint k_absent_key = 0xffffffffu;

// Whether the first key of `bound` or above is this one. `key_before`: 0 for the first of all.
inline bool is_first_from(uint bound, uint key, uint key_before) { return key >= bound && key_before < bound; }

// A word that sorts as the box's lower end does: a float's bits with the sign turned. Large boxes come after all others,
// and empty body slots last.
inline uint sweep_key(Aabb box, SweepAxis sweep)
{
    if (box.lower.x > box.upper.x) return k_absent_key;
    if (is_large(box, sweep)) return k_large_key;
    uint bits = floatBitsToUint(component(box.lower, sweep.axis));
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
