// SPDX-License-Identifier: MIT
// The load on a contact of a hub. The kernel declares BodyColours before this file. The CPU's counterpart is hub_load.h.
// Reads: ManifoldPoints, BodyColours.

layout(std430) readonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };

// What its points carried in the last step (N s).
float load_on(uint pair, uint point_count)
{
    precise float sum = 0.0;
    for (uint i = 0u; i < point_count; ++i)
        sum = sum + uintBitsToFloat(manifold_points[4u * pair + i].cell_2.w); // its normal_impulse
    return sum;
}

// `load`: load_on() of the manifold.
uint part_of_load(Manifold manifold, float load, uint hub)
{
    float largest = uintBitsToFloat(largest_load(body_colours[body_word(hub, k_largest_load)]));
    uint edge_count = body_colours[body_word(hub, k_new_edges)];
    if (largest == 0.0) return part_by_gravity(manifold.normal, manifold.body_a == hub, edge_count, parameters);
    return part_of_load(load, largest, edge_count);
}
