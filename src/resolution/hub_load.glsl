// SPDX-License-Identifier: MIT
// The hub that a manifold is an edge of, and the load on it. The kernel declares BodyColours before this file. The CPU's
// counterpart is hub_load.h.
// Reads: PointImpulses, BodyColours.

layout(std430) readonly buffer PointImpulses { NormalImpulsesCells point_impulses[]; };

bool is_found_hub(uint body) { return body_colours[body_word(body, k_hub_word)] != 0u; }

// k_none where there is none, or both bodies are hubs.
uint hub_of(Manifold manifold)
{
    bool of_a = is_found_hub(manifold.body_a);
    if (of_a == is_found_hub(manifold.body_b)) return k_none;
    return of_a ? manifold.body_a : manifold.body_b;
}

// What its points carried in the last step (N s).
float load_on(uint pair, uint point_count)
{
    vec4 impulses = unpack(point_impulses[pair]).normal;
    precise float sum = 0.0;
    for (uint i = 0u; i < 4u; ++i)
        sum = i < point_count ? sum + impulses[i] : sum;
    return sum;
}

// `load`: load_on() of the manifold.
uint part_of_load(Manifold manifold, float load, uint hub)
{
    float largest = uintBitsToFloat(largest_load(body_colours[body_word(hub, k_largest_load)]));
    uint edge_count = count_new(body_colours[body_word(hub, k_new_edges)]);
    if (largest == 0.0) return part_by_gravity(manifold.normal, manifold.body_a == hub, edge_count, parameters);
    return part_of_load(load, largest, edge_count);
}

uint colours_of_hubs_edge(Manifold manifold, uint part, uint hub, bool both_movable)
{
    bool carries = carries_hub(part, body_colours[body_word(hub, k_whole_load)], manifold.colour);
    return colours_below_hubs(carries, both_movable, manifold.colour,
                              largest_load(body_colours[body_word(hub, k_largest_load)]), parameters);
}
