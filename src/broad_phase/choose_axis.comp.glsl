// SPDX-License-Identifier: MIT
// One invocation: the axis of largest spread from all groups' sums (thesis, section 3.2).
// Reads: SpreadSums.
// Writes: SweepAxes, one record.
// Needs: a barrier after measure_spread.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 1) in;

layout(std430) readonly buffer SpreadSums { SpreadSum spread_sums[]; };
layout(std430) writeonly buffer SweepAxes { SweepAxis sweep_axes[]; };

void main()
{
    uint group_count = (parameters.body_count + k_spread_group - 1u) / k_spread_group;
    SpreadSum sum = empty_spread();
    for (uint group = 0u; group < group_count; group += 1u)
        sum = add_spreads(sum, spread_sums[group]);
    sweep_axes[0] = choose_sweep_axis(sum, parameters.body_count);
}
