// SPDX-License-Identifier: MIT
// The search in the pair table. Needs the blocks PairTable and OldManifolds, and narrow_phase/pair_table.shared.glsl.

// The last step's manifold of a pair, or k_none.
uint find_old_manifold(uint body_a, uint body_b)
{
    uint slot = hash_pair(body_a, body_b) & (parameters.table_size - 1u);
    while (true) {
        uint old = pair_table[slot];
        if (old == k_none) return k_none;
        if (unpack(old_manifolds[old]).body_a == body_a && unpack(old_manifolds[old]).body_b == body_b) return old;
        slot = (slot + 1u) & (parameters.table_size - 1u);
    }
    return k_none;
}
