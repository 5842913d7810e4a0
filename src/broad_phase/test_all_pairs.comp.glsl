// SPDX-License-Identifier: MIT
// One invocation is a body, tested against every body after it (thesis, algorithm 1): the oracle of the sweep.
// Run twice: args.x = 0 counts, 1 writes at the scanned offsets.
// Reads: Counters, Aabbs, OrientedBoxes.
// Writes: PairCounts (counting) or Pairs (writing).
// Needs: a barrier after update_aabbs; for writing, after the scan of the counts.
// Overflow: the counts' sum is the demand; pairs beyond the capacity are not written.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) buffer PairCounts { uint pair_counts[]; };
layout(std430) writeonly buffer Pairs { Pair pairs[]; };

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_search_count]) return;
    bool writing = args.x == 1u;
    uint offset = writing ? pair_counts[body] : 0u;
    uint found = 0u;
    Aabb box = unpack(aabbs[body]);
    OrientedBox oriented = unpack(oriented_boxes[body]);
    for (uint other = body + 1u; other < parameters.body_count; other += 1u) {
        if (is_candidate(box, unpack(aabbs[other])) && !faces_part(oriented, unpack(oriented_boxes[other]))) {
            if (writing && offset + found < parameters.pair_capacity) pairs[offset + found] = make_pair(body, other);
            found += 1u;
        }
    }
    if (!writing) pair_counts[body] = found;
}
