// SPDX-License-Identifier: MIT
// One invocation is a body slot: the key that sorts it along the sweep's axis.
// Reads: Counters, Aabbs, SweepAxes.
// Writes: SortKeys, SortValues (the body).
// Needs: a barrier after choose_axis.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer SweepAxes { SweepAxis sweep_axes[]; };
layout(std430) writeonly buffer SortKeys { uint sort_keys[]; };
layout(std430) writeonly buffer SortValues { uint sort_values[]; };

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_search_count]) return;
    sort_keys[body] = sweep_key(unpack(aabbs[body]), sweep_axes[0]);
    sort_values[body] = body;
}
