// SPDX-License-Identifier: MIT
// One group: the cells of the tree's order from all groups' sums.
// Reads: Counters, SpreadSums.
// Writes: TreeGrids, one record.
// Needs: a barrier after measure_spread.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"
#include "broad_phase/curve.shared.glsl"

layout(local_size_x = 256) in; // k_spread_group

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer SpreadSums { SpreadSum spread_sums[]; };
layout(std430) writeonly buffer TreeGrids { TreeGrid tree_grids[]; };

#include "broad_phase/sum_spread.glsl"

void main()
{
    if (counters[k_counter_search_count] == 0u) return;
    SpreadSum sum = sum_spread();
    if (gl_LocalInvocationID.x == 0u) tree_grids[0] = choose_tree_grid(sum, parameters.body_count);
}
