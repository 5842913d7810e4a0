// SPDX-License-Identifier: MIT
// One invocation is a manifold in the order of colours: its impulses and its colour go back to where the next step, and
// the caller, find them.
// Reads: Counters, Constraints, ConstraintPoints, ManifoldKeys.
// Writes: ManifoldPoints and Manifolds (impulses, colour).
// Needs: a barrier after the last pass of the solver.
// Overflow: none; launched empty after a step that did not fit.

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Constraints { ContactConstraint constraints[]; };
layout(std430) readonly buffer ConstraintPoints { ContactConstraintPoint constraint_points[]; };
layout(std430) readonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) writeonly buffer Manifolds { Manifold manifolds[]; };
layout(std430) writeonly buffer ManifoldPoints { ManifoldPoint manifold_points[]; };

void main()
{
    uint index = item_index();
    if (index >= counters[k_counter_manifold_count]) return;
    uint manifold = constraints[index].manifold;
    manifolds[manifold].colour = manifold_keys[index] & ((1u << k_colour_bits) - 1u);
    manifolds[manifold].tangent_impulse_1 = constraints[index].tangent_impulse_1;
    manifolds[manifold].tangent_impulse_2 = constraints[index].tangent_impulse_2;
    manifolds[manifold].twist_impulse = constraints[index].twist_impulse;
    for (uint i = 0u; i < constraints[index].point_count; ++i)
        manifold_points[4u * manifold + i].normal_impulse = constraint_points[4u * index + i].normal_impulse;
}
