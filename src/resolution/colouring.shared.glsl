// SPDX-License-Identifier: MIT
// Colouring of the constraint graph: manifolds are edges between bodies, and no two edges of one colour may meet at a
// body that can move. Jones and Plassmann's scheme (1993): an edge takes the first free colour once it outranks all
// uncoloured edges at both its bodies.
//
// The rank of an edge is a one-to-one mix of a XOR b. At a body all edges lead to different other bodies, so all ranks
// there differ: no ties, though ranks of edges far apart may be equal. The result is that of a greedy colouring in the
// order of ranks, whatever the order in which edges are listed or threads run.
//
// Colours are solved in ascending order, and given from the last one down. What is solved last holds, and a light box
// under a heavy one must not be pressed into the ground: so edges to the ground, which is all that cannot be pushed, are
// coloured first and get the last colour. It is lent to others where a body has many. solver.md, The ground last.

const uint k_rank_mask = 0x3fffffffu; // slots are below 2^30
// Of 1,500 numbers the one with the fewest colours over eight scenes of walls, pyramids and columns: 8 instead of 9.
const uint k_rank_start = 0x1db40204u;
const uint k_on_ground = 0x80000000u;

// Of two different bodies, in either order. Not 0.
inline uint edge_rank(uint body_a, uint body_b, bool both_movable)
{
    uint x = ((body_a ^ body_b) + k_rank_start) & k_rank_mask;
    x ^= x >> 15;
    x = (x * 0x2c1b3c6du) & k_rank_mask;
    x ^= x >> 14;
    x = (x * 0x297a2d39u) & k_rank_mask;
    x ^= x >> 15;
    return 2u * x + 1u + (both_movable ? 0u : k_on_ground);
}

// How many have been given where this is the last one.
inline uint colours_down_to(uint colour) { return k_first_hub_colour - colour; }

// Of the colours from 32 on: a bit each.
const uint k_for_hubs = ~0u << (k_first_hub_colour - 32u);
const uint k_for_ground = 1u << (k_ground_colour - 32u);
const uint k_next_two = 3u << (k_ground_colour - 34u);

// The first of `usable` colours that is free in both sets of used colours (64 bits in two words), or the overflow set.
inline uint first_free_colour(uint used_low, uint used_high, uint usable, bool both_movable)
{
    uint free_low = ~used_low;
    bool leaves_last = both_movable && (used_high & k_next_two) != k_next_two;
    uint free_high = ~(used_high | k_for_hubs | (leaves_last ? k_for_ground : 0u));
    if ((free_low | free_high) == 0u) return k_overflow_colour;
    uint colour = free_high != 0u ? 32u + uint(findMSB(free_high)) : uint(findMSB(free_low));
    return colours_down_to(colour) <= usable ? colour : k_overflow_colour;
}

// The same for a manifold of a hub: at its other body.
inline uint first_free_hub_colour(uint used_high)
{
    uint free = ~used_high >> (k_first_hub_colour - 32u);
    return free != 0u ? k_first_hub_colour + uint(findLSB(free)) : k_overflow_colour;
}

// The ground's last colour is only lent to others: one of the bodies may come to the ground, and what is solved before the rest
// would be so for as long as they touch. An edge gives it back then, and where one of the two colours beside it is free.
// `used_high`: of both bodies; `new_edges_a`, `new_edges_b`: their words.
const uint k_new_on_ground = 0x80000000u; // in the word k_new_edges: one of them is on what cannot be pushed

inline bool is_lent(uint colour, bool both_movable) { return both_movable && colour == k_ground_colour; }

inline bool gives_back(uint used_high, uint new_edges_a, uint new_edges_b)
{
    bool is_needed = ((new_edges_a | new_edges_b) & k_new_on_ground) != 0u;
    return is_needed || (used_high & k_next_two) != k_next_two;
}

// An edge far down, in one of the colours that only a few have needed, gives its colour up where that is further down than
// either body has edges, the ground's last colour not counted: it was needed by edges that are gone. All that do are coloured again
// in the order of ranks. A second graph of the same edges gives them the same colours: each finds taken what was taken before, the
// two beside the ground's colour too, and its own colour free. (That holds as nothing that is coloured class by class
// keeps a colour far down.)
const uint k_many_colours = 9u;

inline bool is_far_down(uint colour) { return colours_down_to(colour) > k_many_colours; }

inline bool gives_up(uint colour, uint edges_a, uint edges_b) { return colours_down_to(colour) > max(edges_a, edges_b) + 1u; }

// What has kept a colour that it may give up, one far down or lent by the ground, is doubtful until it is known which colours have been
// kept, and what is new: it is listed from the end of the list of what has no colour. There stands, beside a pair: it has kept a colour,
// or has got one.
const uint k_has_kept = 0x80000000u;
const uint k_has_got = 0x40000000u;

// Where all edges are new, as those of a structure that has been set up standing, and none is far down, they are coloured again class
// by class: J. Culberson, "Iterated Greedy Graph Coloring and the Difficulty Landscape", 1992. Edges of one colour do not
// meet, so a class has one rank, and its edges get no colour further down than its place among the classes, or one more where the
// ground's is not for them: each time may take a colour more, but mostly takes one less. The last colours come first, which are
// of few edges. What was lent the ground's colour comes before them, as it may have to do without. Where some are far down in the end
// all are coloured by rank once more, as they were at first.
const uint k_times_again = 2u;

// Of an edge that had this colour.
inline uint class_rank(uint colour, bool both_movable)
{
    if (!both_movable) return k_on_ground + colours_down_to(colour);
    return colour == k_ground_colour ? k_max_colours : colours_down_to(colour);
}

// Whether the solver treats a manifold: the bodies touch, or are about to, and neither is a sensor.
inline bool is_active(Manifold manifold)
{
    return manifold.point_count > 0u && manifold.colour != k_inactive_colour;
}

// Words of a body slot in FastBodies: two for each doubling of the sub-steps, and one more, see solve_in_order.glsl.
inline uint fast_body_words(uint fewest_substeps, uint most_substeps)
{
    return 2u * uint(findMSB(most_substeps / fewest_substeps)) + 1u;
}

// Words of BodyColours.
const uint k_used_low = 0u;  // colours 0-31 in use at the body, a bit each
const uint k_used_high = 1u; // colours 32-63
const uint k_best_rank = 2u; // highest rank of the uncoloured edges; two words that take turns, round by round
const uint k_new_edges = 4u; // edges that had no colour at the start of the step, and k_new_on_ground
const uint k_hub_word = 5u;  // k_is_hub, and the number of edges that have no share: few, so that few count themselves
// Of a hub.
const uint k_largest_load = 6u;  // of its edges (N s): the bits of a float and 1
const uint k_whole_load = 7u;    // of all its edges together, in parts (hub_load.shared.glsl)
const uint k_unshared_load = 8u; // of those that have no share
const uint k_body_words = 9u;

inline uint count_new(uint new_edges) { return new_edges & ~k_new_on_ground; }

inline uint body_word(uint body, uint word) { return k_body_words * body + word; }

// Where a colour in use at a body has its bit, and the bit.
inline uint used_word(uint colour) { return colour < 32u ? k_used_low : k_used_high; }
inline uint used_bit(uint colour) { return 1u << (colour & 31u); }

// ---- the order at a body ----

// Of the colours in use at a body, how many come before this one.
inline uint count_earlier(uint used_low, uint used_high, uint colour)
{
    uint below = used_bit(colour) - 1u;
    return uint(bitCount(colour < 32u ? used_low & below : used_low)) +
           uint(bitCount(colour < 32u ? 0u : used_high & below));
}

// See contact_counts.shared.glsl. `pushed`: whether contacts push the body; `contacts`: those that it has in these colours;
// `earlier_shift`, `last_shift`: those of A, or of B.
inline uint order_at_body(bool pushed, uint contacts, uint used_low, uint used_high, uint colour, uint earlier_shift,
                          uint last_shift)
{
    if (!pushed || colour >= k_first_hub_colour) return 0u;
    uint earlier = count_earlier(used_low, used_high, colour);
    uint last = choose(earlier + 1u == contacts, 1u, 0u);
    return earlier << earlier_shift | last << last_shift;
}

// ---- hubs ----
//
// A body with more contacts than there are colours would have most of them solved one after the other. Such a hub does
// not stand in the way of a colour: its edges take one of the last colours, in which only their other bodies must
// differ. See hub.shared.glsl for what that means to the solver.
//
// What carries much of a hub is too much for a share. An edge with more than a 16th of the load on all of the hub's is
// coloured as those of other bodies are, until it has less than a 32nd: so there are never more than 31 of them. So are
// the first edges to what cannot be pushed, which may carry the hub and all that lies on it, and the first that are new
// where others are not: with a share in its first step, a block of 25 t that fell on a plate of 38 t threw the
// boxes below at 37 m/s.
//
// Edges of a hub are coloured anew with each graph, as their loads change, and a graph lasts as long as they would all
// get the colours that they have.

const uint k_is_hub = 0x80000000u;
const uint k_parts_to_carry = 16u;
const uint k_parts_to_carry_on = 32u;
const uint k_colours_for_first = 4u; // that those may take

inline uint count_edges(uint used_low, uint used_high, uint new_edges)
{
    return uint(bitCount(used_low)) + uint(bitCount(used_high)) + count_new(new_edges);
}

inline bool is_hub(uint edge_count, Parameters p) { return edge_count > p.hub_contacts; }

inline bool carries_hub(uint part, uint whole_load, uint last_colour)
{
    bool did = last_colour != k_no_colour && (last_colour & k_whole_hub) != 0u;
    return part > whole_load / (did ? k_parts_to_carry_on : k_parts_to_carry);
}

// Of how many colours, from the first on, an edge of a hub may take one instead of a share.
inline uint colours_below_hubs(bool carries, bool both_movable, uint last_colour, uint largest_load, Parameters p)
{
    if (carries) return p.usable_colours;
    bool lands = last_colour == k_no_colour && largest_load != 0u;
    return lands || !both_movable ? min(p.usable_colours, k_colours_for_first) : 0u;
}

// Whether an edge of a hub that has this colour gets it again where it may take one of the first `usable` ones, if all
// other edges keep theirs. With the whole hub it took the first that was free. One that got none was refused as many as its
// kind may have at least.
inline bool keeps_colour(uint colour, uint usable, bool both_movable, Parameters p)
{
    if (colour == k_no_colour) return false;
    if ((colour & k_whole_hub) != 0u) return colours_down_to(colour & ~k_whole_hub) <= usable;
    return usable <= (both_movable ? 0u : min(p.usable_colours, k_colours_for_first));
}

inline uint shares_of_hub(uint new_edges, uint hub_word) { return count_new(new_edges) - (hub_word & ~k_is_hub); }

inline uint largest_load_word(uint load) { return load + 1u; }
inline uint largest_load(uint word) { return word - 1u; }

// What the graph adds to a body's traits, by its words.
inline uint traits_in_graph(uint its_traits, uint used_low, uint used_high, uint hub_word)
{
    uint contacts = (its_traits & k_trait_movable) != 0u ? count_earlier(used_low, used_high, k_first_hub_colour) : 0u;
    return (hub_word != 0u ? k_trait_hub : 0u) | contacts << k_contacts_of_body;
}
