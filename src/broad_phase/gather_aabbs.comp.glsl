// SPDX-License-Identifier: MIT
// One invocation is a place in the sorted order: its body's box, so that the sweep reads boxes one after the other; and
// whether the large bodies, or the empty slots, begin here.
// Reads: Counters, Aabbs, SortKeys, SortValues.
// Writes: SortedAabbs, SweepAxes (first_large, end).
// Needs: a barrier after the sort.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer SortKeys { uint sort_keys[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) writeonly buffer SortedAabbs { AabbCells sorted_aabbs[]; };
layout(std430) writeonly buffer SweepAxes { SweepAxis sweep_axes[]; };

void main()
{
    uint place = item_index();
    if (place >= counters[k_counter_search_count]) return;
    sorted_aabbs[place] = aabbs[sort_values[place]];
    uint key = sort_keys[place];
    uint key_before = place > 0u ? sort_keys[place - 1u] : 0u;
    if (is_first_from(k_large_key, key, key_before)) sweep_axes[0].first_large = place;
    if (is_first_from(k_absent_key, key, key_before)) sweep_axes[0].end = place;
}
