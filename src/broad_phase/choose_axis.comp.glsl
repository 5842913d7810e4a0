// SPDX-License-Identifier: MIT
// One group: the axis of largest spread from all groups' sums (thesis, section 3.2).
// Reads: Counters, SpreadSums.
// Writes: SweepAxes, one record.
// Needs: a barrier after measure_spread.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 256) in; // k_spread_group

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer SpreadSums { SpreadSum spread_sums[]; };
layout(std430) writeonly buffer SweepAxes { SweepAxis sweep_axes[]; };

#include "broad_phase/sum_spread.glsl"

void main()
{
    if (counters[k_counter_search_count] == 0u) return;
    SpreadSum sum = sum_spread();
    if (gl_LocalInvocationID.x == 0u) sweep_axes[0] = choose_sweep_axis(sum, parameters.body_count);
}
