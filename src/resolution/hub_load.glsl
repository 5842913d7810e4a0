// SPDX-License-Identifier: MIT
// The load on a contact of a hub. The CPU's counterpart is hub_load.h.
// Reads: ManifoldPoints, BodyColours (which the kernel declares).

layout(std430) readonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };

// What its points carried in the last step (N s).
float load_on(uint pair, uint point_count)
{
    precise float sum = 0.0;
    for (uint i = 0u; i < point_count; ++i)
        sum = sum + uintBitsToFloat(manifold_points[4u * pair + i].cell_2.w); // its normal_impulse
    return sum;
}

uint part_of_load(uint pair, uint point_count, uint hub)
{
    return part_of_load(load_on(pair, point_count), body_colours[body_word(hub, k_largest_load)],
                        body_colours[body_word(hub, k_new_edges)]);
}
