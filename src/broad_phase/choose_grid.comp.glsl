// SPDX-License-Identifier: MIT
// One group: the cells of the tree's order from all groups' sums, each invocation those of every k_spread_group-th,
// then added as a tree.
// Reads: SpreadSums.
// Writes: TreeGrids, one record.
// Needs: a barrier after measure_spread.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"
#include "broad_phase/curve.shared.glsl"

layout(local_size_x = 256) in; // k_spread_group

layout(std430) readonly buffer SpreadSums { SpreadSum spread_sums[]; };
layout(std430) writeonly buffer TreeGrids { TreeGrid tree_grids[]; };

shared SpreadSum sums[k_spread_group];

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint group_count = (parameters.body_count + k_spread_group - 1u) / k_spread_group;
    SpreadSum sum = empty_spread();
    for (uint group = me; group < group_count; group += k_spread_group)
        sum = add_spreads(sum, spread_sums[group]);
    sums[me] = sum;
    for (uint half_size = k_spread_group / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (me < half_size) sums[me] = add_spreads(sums[me], sums[me + half_size]);
    }
    if (me == 0u) tree_grids[0] = choose_tree_grid(sums[0], parameters.body_count);
}
