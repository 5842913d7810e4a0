// SPDX-License-Identifier: MIT
// Islands, and the order in which manifolds stand for the solver.

inline bool is_mover(BodyShape shape)
{
    uint kind = shape.type >> 8;
    return kind == k_kind_rigid || kind == k_kind_kinematic;
}

// Manifolds are sorted by island, and within it by colour.
inline uint manifold_key(uint island, uint colour) { return (island << k_colour_bits) | colour; }
