// SPDX-License-Identifier: MIT
// Bodies that have left the boxes of the last search get boxes anew, and the list of pairs gets those of their pairs that it has
// not. Pairs that are near no more stay in it until all are searched for, so all others keep their places, and a constraint graph of
// them may last.

// How many bodies of so many may be searched for by themselves.
inline uint most_strays(uint body_count, bool has_tree)
{
    return choose(has_tree, max(body_count / k_share_of_strays, k_compared_strays), k_compared_strays);
}

// Of so many, those that search the tree: all, or none where they are so few that all bodies are sooner compared with each.
// `search_count`: not 0 where all are searched for instead.
inline uint strays_in_tree(uint stray_count, uint search_count)
{
    return choose(stray_count > k_compared_strays && search_count == 0u, stray_count, 0u);
}

// Of so many, those whose pairs are found: all, or none where all are searched for instead or the tree had no launches.
inline uint found_strays(uint stray_count, uint search_count, bool with_tree)
{
    bool found = search_count == 0u && (with_tree || strays_in_tree(stray_count, search_count) == 0u);
    return choose(found, stray_count, 0u);
}

const uint k_strays_a_group = 16u; // that go down the tree together

// Pairs of strays that are near, and were not before.
inline uint most_near_pairs(uint body_count)
{
    return min(k_near_a_stray * most_strays(body_count, true), k_most_near_pairs);
}

// Slots of NearTable: a power of two, of which at most half are in use.
inline uint near_table_size(uint body_count) { return 2u << (findMSB(most_near_pairs(body_count) - 1u) + 1); }

// Whether so many pairs have been added to the list since it was made that a new one would be much shorter, or so many bodies have
// strayed that those beside each other in the tree may be far apart.
inline bool has_aged(uint added, uint pair_count, uint all_strays, uint body_count)
{
    return added > pair_count / k_share_added || all_strays > body_count;
}

// In StrayMarks: of a stray, and of one that is near to somebody it was not near to.
const uint k_stray = 1u;
const uint k_stray_near = 2u;

// In NearPairs: of a pair that is in the list.
inline bool is_known(Pair pair) { return pair.body_a == k_none; }

// The order in which pairs are added.
inline bool comes_before(Pair a, Pair b)
{
    return a.body_a < b.body_a || (a.body_a == b.body_a && a.body_b < b.body_b);
}

inline bool is_same_pair(Pair a, Pair b) { return a.body_a == b.body_a && a.body_b == b.body_b; }
