// SPDX-License-Identifier: MIT
// Islands, and the order in which manifolds stand for the solver.
//
// Islands are the sets of rigid bodies that contacts join. They are found by union and find, and each is named by the body that
// is its root, whoever comes first: in a small world the lowest slot, in a large one the first by order_of_root.

// Manifolds are sorted by what solves them, and within it by colour: by island in a small world, by group in a large one. What
// launches solve comes first; of each of its colours first what is fast in a multirate island, by its slowness, so that workers
// can share each rate evenly. Where islands are not told apart, and no group solves any, the key is the colour itself, which is
// less than all of these. A world of 59,000 bodies has keys of 16 bits, two passes of the sort.
const uint k_first_launched_key = k_inactive_colour + 1u;
const uint k_first_group_key = k_first_launched_key + k_slownesses * k_colours_of_key;

inline uint launched_key(uint colour, uint its_slowness) { return k_first_launched_key + k_slownesses * colour + its_slowness; }

// The lowest key of a colour that launches solve. `apart`: islands are told apart.
inline uint first_key(uint colour, bool apart) { return choose(apart, launched_key(colour, 0u), colour); }
// Of ColourOffsets: where what has the slowness r or a lesser one ends.
inline uint rate_end_word(uint colour, uint r) { return k_rate_ends + r * k_max_colours + colour; }

inline uint manifold_key(uint island, uint colour) { return k_first_group_key + island * k_colours_of_key + colour; }

inline uint colour_of_key(uint key)
{
    if (key < k_first_launched_key) return key;
    return key < k_first_group_key ? (key - k_first_launched_key) / k_slownesses : (key - k_first_group_key) % k_colours_of_key;
}

inline uint island_of_key(uint key) { return (key - k_first_group_key) / k_colours_of_key; }

// ---- large worlds ----

// In IslandSizes, above a count of the island's bodies: the highest foot rate of the contacts of the body itself, see
// multirate.shared.glsl.
const uint k_foot_rate_shift = 29u;

inline uint island_size(uint word) { return word & ((1u << k_foot_rate_shift) - 1u); }
inline uint foot_rate_at(uint word) { return word >> k_foot_rate_shift; }

// A permutation of the slots, without a pattern: things next to each other often have slots in a row, and with the lowest slot as
// the root the way to it would be as long as the row.
inline uint order_of_root(uint body) { return body * 0x9e3779b1u; }

// In IslandFill, beside a count of bodies that have a place. A body may be restless, or touch one that is; an island is awake
// where any of it is or does. Quiet is what stands, and what sleeps as a part of a large island: contacts between the quiet join
// nothing, as such a part stands for its island. It is reached where something else touches it. Once it is known who sleeps: a sleeper
// that something awake touches is pressed. A body is tall where a contact of it stands in a tall column, and an island
// where any body of it is; that is forgotten where parts of islands may sleep, and of no use.
const uint k_restless = 0x80000000u;
const uint k_touched = 0x40000000u;
const uint k_awake = 0x20000000u;
const uint k_pressed = 0x10000000u;
const uint k_quiet = 0x08000000u;
const uint k_reached = 0x04000000u;
const uint k_tall = 0x02000000u;
const uint k_fill_count = 0x01ffffffu;

// What join_islands joins: all that contacts can push; the same, and it notes what restless bodies touch; or what is awake, of which it
// is known already what it asks for.
const uint k_join_all = 0u;
const uint k_join_to_sleep = 1u;
const uint k_join_awake = 2u;

// Of which pairs join_islands treats: those of every group of invocations, or of each second one, and of the others when paths have been
// shortened. Half of the contacts of a heap join most of what there is (M. Sutton, T. Ben-Nun and A. Barak, "Optimizing Parallel Graph
// Connectivity Computation via Subgraph Sampling", 2018).
const uint k_pairs_all = 0u;
const uint k_pairs_first = 1u;
const uint k_pairs_others = 2u;

inline bool is_in_part(uint group, uint part) { return part == k_pairs_all || (group & 1u) == part - k_pairs_first; }

// What is kept of a large island for a body that sleeps as a part of it, in BodyRest::calm: the sub-steps that the body's contacts ask
// for, of a multirate island those that it has; and, unless each had its own, those that the whole island did; and whether it had so
// many bodies that it might be multirate. It counts as calm for however long.
const uint k_kept_island = 0x80000000u;
const uint k_kept_many = 0x20000000u;
const uint k_kept_shift = 12u; // of the island's sub-steps

// Whether that is to be kept of a sleeper. k_kept_island alone says that what has been kept stays. `had_part`: it was one already; then it
// is found anew where all pairs have been searched for.
inline bool keeps_anew(uint kept, bool had_part, bool other_pairs)
{
    return kept != 0u && kept != k_kept_island && (!had_part || other_pairs);
}

inline uint own_substeps_kept(uint kept) { return kept & ((1u << k_kept_shift) - 1u); }
inline uint substeps_kept(uint kept) { return (kept >> k_kept_shift) & ((1u << k_kept_shift) - 1u); }

// In IslandStarts while it is asked who sleeps: what parts that have been reached say of an island, besides its sub-steps.
const uint k_has_part = 1u;
const uint k_has_many = 2u;

inline uint parts_said(uint kept) { return k_has_part | ((kept & k_kept_many) != 0u ? k_has_many : 0u); }

// An island as it is to be known who sleeps of it. `size`: of IslandSizes.
struct IslandAtRest {
    bool in_parts;  // what rests may sleep while other parts of it move: a small one is solved as a whole, and at once
    bool many;      // so many bodies that it may be multirate
    bool multirate;
};

inline IslandAtRest island_at_rest(uint size, uint parts, uint least_multirate, bool may_be_multirate)
{
    IslandAtRest island;
    island.in_parts = island_size(size) > k_most_single || parts != 0u;
    island.many = island_size(size) >= least_multirate || (parts & k_has_many) != 0u;
    island.multirate = island.many && may_be_multirate;
    return island;
}

inline uint keep_island(IslandAtRest island, uint own_substeps, uint substeps)
{
    return k_kept_island | (island.many ? k_kept_many : 0u) | ((island.multirate ? own_substeps : substeps) << k_kept_shift) |
           own_substeps;
}

// What prepare_bodies is told, a bit each.
const uint k_with_records = 1u;
const uint k_with_parts = 2u;
const uint k_with_loads = 4u;

const uint k_launched = 0u; // in place of a group: the island has too many bodies for one

// Whether an island with too many bodies to share a group has few enough for one of its own.
inline bool is_single(uint size) { return size > k_most_grouped && size <= k_most_single; }

const uint k_single = 0x80000000u; // in IslandGroups, beside the group of such an island
inline uint single_group(uint group) { return group | k_single; }
inline uint group_number(uint group) { return group & ~k_single; }

// What IslandGroups says of an island's bodies. Groups are counted from 1, so that what is launched comes first. A single
// island reaches beyond the window that follows the one it begins in. So none begins there, and it has that window's number.
inline uint island_group(uint size, uint start, bool has_singles)
{
    uint window = start / k_group_window;
    if (size <= k_most_grouped) return window + 1u;
    return has_singles && is_single(size) ? single_group(window + 2u) : k_launched;
}

// Where a work group has a body that is at `place` in the order of islands, in which its own are the `room` from `first` on.
// Slot 0 is for all others, and what nothing moves, whose place is k_none.
inline uint slot_at(uint place, uint first, uint room)
{
    uint own = place - first;
    return own < room ? own + 1u : 0u;
}

inline uint count_groups(uint body_count) { return (body_count + k_group_window - 1u) / k_group_window; }

// Of a pair that does not touch: the largest of all.
inline uint inactive_key(uint body_count) { return manifold_key(count_groups(body_count) + 1u, k_inactive_colour); }
