// SPDX-License-Identifier: MIT
// One invocation is a pair of the last step: if it touched, the table learns where its manifold is.
// Reads: Counters, OldManifolds.
// Writes: PairTable. Which slot a pair gets depends on who comes first; what a search finds does not.
// Needs: a barrier after clear_pair_table.
// Overflow: none; the table has at least two slots a pair.
#include "narrow_phase/pair_table.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) buffer PairTable { uint pair_table[]; };

void main()
{
    uint pair = item_index();
    if (pair >= counters[k_counter_old_pair_count]) return;
    Manifold manifold = unpack(old_manifolds[pair]);
    if (manifold.point_count == 0u) return;
    uint slot = hash_pair(manifold.body_a, manifold.body_b) & (parameters.table_size - 1u);
    while (atomicCompSwap(pair_table[slot], k_none, pair) != k_none)
        slot = (slot + 1u) & (parameters.table_size - 1u);
}
