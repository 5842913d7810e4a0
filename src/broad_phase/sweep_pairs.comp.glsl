// SPDX-License-Identifier: MIT
// One invocation is a body in sorted order: sweeps the bodies after it until their boxes begin beyond its own end, and
// then all large ones (thesis, algorithm 2). Run twice: args.x = 0 counts, 1 writes at the scanned offsets.
// Reads: SortedAabbs, SweepAxes, SortValues.
// Writes: PairCounts (counting) or Pairs (writing), in the order of the sort.
// Needs: a barrier after gather_aabbs; for writing, after the scan of the counts.
// Overflow: the counts' sum is the demand; pairs beyond the capacity are not written.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer SortedAabbs { Aabb sorted_aabbs[]; };
layout(std430) readonly buffer SweepAxes { SweepAxis sweep_axes[]; };
layout(std430) readonly buffer SortValues { uint sort_values[]; };
layout(std430) buffer PairCounts { uint pair_counts[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };

void main()
{
    uint place = item_index();
    if (place >= parameters.body_count) return;
    bool writing = args.x == 1u;
    uint offset = writing ? pair_counts[place] : 0u;
    uint found = 0u;
    uint body = sort_values[place];
    Aabb box = sorted_aabbs[place];
    uint axis = sweep_axes[0].axis;
    uint first_large = sweep_axes[0].first_large;
    // The sweep ends at the first box beyond this one's end, and goes on with the large boxes.
    bool sweeping = place < first_large;
    uint i = place + 1u;
    uint end = sweep_axes[0].end;
    while (i < end) {
        Aabb other_box = sorted_aabbs[i];
        if (sweeping && (i >= first_large || component(other_box.lower, axis) > component(box.upper, axis))) {
            sweeping = false;
            i = first_large;
            continue;
        }
        if (is_candidate(box, other_box)) {
            if (writing && offset + found < parameters.pair_capacity) pairs[offset + found] = make_pair(body, sort_values[i]);
            found += 1u;
        }
        i += 1u;
    }
    if (!writing) pair_counts[place] = found;
}
