// SPDX-License-Identifier: MIT
// A few bodies that have left the boxes of the last search get boxes anew, and the list of pairs gets those of their pairs that it has
// not. Pairs that are near no more stay in it until all are searched for, so all others keep their places, and a constraint graph of
// them may last.

// How many bodies of so many may be searched for by themselves: a thousandth, as each looks at all strays.
inline uint most_strays(uint body_count) { return min(max(body_count / 1024u, 64u), k_most_strays); }

// Of these: that are in the list, and that are near.
inline uint most_stray_pairs(uint body_count) { return k_pairs_a_stray * most_strays(body_count); }

// Whether the list has had so many pairs added since it was made that a new one would be much shorter.
inline bool is_much_added(uint added, uint pair_count) { return added > pair_count / k_share_added; }

// In StrayMarks: of a stray, and of one that is near to somebody it was not near to.
const uint k_stray = 1u;
const uint k_stray_near = 2u;

// The order in which pairs are added.
inline bool comes_before(Pair a, Pair b)
{
    return a.body_a < b.body_a || (a.body_a == b.body_a && a.body_b < b.body_b);
}

inline bool is_same_pair(Pair a, Pair b) { return a.body_a == b.body_a && a.body_b == b.body_b; }
