// SPDX-License-Identifier: MIT
// One group is k_spread_group body slots: their sums, added as a tree of fixed shape so that the rounding is the same
// on every device.
// Reads: Counters, Aabbs.
// Writes: SpreadSums, one a group.
// Needs: a barrier after update_aabbs.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 256) in; // k_spread_group

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) writeonly buffer SpreadSums { SpreadSum spread_sums[]; };

shared SpreadSum sums[k_spread_group];

void main()
{
    if (counters[k_counter_search_count] == 0u) return;
    uint me = gl_LocalInvocationID.x;
    uint body = item_index();
    if (body < parameters.body_count)
        sums[me] = spread_of(unpack(aabbs[body]));
    else
        sums[me] = empty_spread();
    for (uint half_size = k_spread_group / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (me < half_size) sums[me] = add_spreads(sums[me], sums[me + half_size]);
    }
    if (me == 0u) spread_sums[group_index()] = sums[0];
}
