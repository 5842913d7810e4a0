// SPDX-License-Identifier: MIT
// The order in which manifolds stand for the solver.

// Manifolds are sorted by island, and within it by colour.
inline uint manifold_key(uint island, uint colour) { return (island << k_colour_bits) | colour; }
