// SPDX-License-Identifier: MIT
// Colouring of the constraint graph: manifolds are edges between bodies, and no two edges of one colour may meet at a
// body that can move. Jones and Plassmann's scheme (1993): an edge takes the smallest free colour once it outranks all
// uncoloured edges at both its bodies.
//
// An edge ranks by how far apart its bodies' slots are. What is built row by row has few such distances, and the edges of
// one distance are chains x, x + d, x + 2 d ... that take turns: walls and pyramids get as few colours as a body has
// neighbours. Ranks differ at a body: only the two edges of one chain have the same distance there, and they have not the
// same turn. Edges to bodies that cannot be pushed come last: what is solved last holds, and a light box under a heavy one
// must not be pressed into the floor. Ranks of edges far apart may be equal. The result is that of a greedy colouring in the order of ranks,
// whatever the order in which edges are listed or threads run.

// Leading bits of a distance that count as they are. The others are reversed: where distances fall along a chain of edges,
// as from row to row of a pyramid, an edge must not wait for all before it.
const uint k_distance_bits = 4u;

inline uint scattered_distance(uint distance)
{
    uint length = uint(findMSB(distance)) + 1u;
    if (length <= k_distance_bits) return distance;
    uint tail = length - k_distance_bits;
    uint leading = (distance >> tail) << tail;
    return leading | (bitfieldReverse(distance - leading) >> (32u - tail));
}

const uint k_both_movable = 0x80000000u;

// Of two different bodies, in either order. Not 0.
inline uint edge_rank(uint body_a, uint body_b, bool both_movable)
{
    uint lower = min(body_a, body_b);
    uint distance = max(body_a, body_b) - lower;
    uint turn = (lower / distance) & 1u;
    return 2u * scattered_distance(distance) + turn + (both_movable ? k_both_movable : 0u);
}

// The lowest colour that is free in both sets of used colours (64 bits in two words), or the overflow set.
inline uint first_free_colour(uint used_low, uint used_high)
{
    if (used_low != 0xffffffffu) return uint(findLSB(~used_low));
    return used_high != 0xffffffffu ? 32u + uint(findLSB(~used_high)) : k_overflow_colour;
}

// Words of BodyColours, four a body.
const uint k_used_low = 0u;  // colours 0-31 in use at the body, a bit each
const uint k_used_high = 1u; // colours 32-63
const uint k_best_rank = 2u; // highest rank of the uncoloured edges; two words that take turns, round by round

inline uint body_word(uint body, uint word) { return 4u * body + word; }
