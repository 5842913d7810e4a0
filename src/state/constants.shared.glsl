// SPDX-License-Identifier: MIT
// Constants of both languages.

const uint k_none = 0xffffffffu; // no such index

// Limits of a world
const uint k_most_bodies = 1u << 24;
const uint k_most_pairs = 1u << 28; // four points each still have 32-bit indices
const uint k_had_contact = 1u << 31; // in PairsToCollide: the pair had one in the last step, and may have it still

// BodyShape::type
const uint k_shape_box = 0u;
const uint k_shape_sphere = 1u;
const uint k_kind_static = 0u;
const uint k_kind_rigid = 1u;
const uint k_kind_kinematic = 2u;
const uint k_kind_absent = 255u; // an empty body slot
const uint k_sensor_bit = 0x10000u;

// ContactStates
const uint k_contact_apart = 0u;
const uint k_contact_touches = 1u;

// ContactReport::phase
const uint k_phase_begin = 0u;
const uint k_phase_persist = 1u;
const uint k_phase_end = 2u;

// BodyPose::flags
const uint k_body_frozen = 1u; // went non-finite; stays where it was
const uint k_body_placed = 2u; // the caller put it there since the last step
const uint k_body_asleep = 4u; // it sleeps
const uint k_body_disturbed = 8u; // the caller has changed it since the last step; only while islands may sleep
const uint k_body_settled = 16u; // it slept, or stood, when the last step looked for contacts, too; only while islands may sleep
const uint k_body_in_part = 32u; // it sleeps as a part of a large island
const uint k_rest_shift = 8u; // from this bit on: steps in a row in which it has rested

// BodyInertia::traits
const uint k_trait_movable = 1u; // contacts can push the body
const uint k_trait_round = 2u;   // a sphere: where it is touched does not turn with it
const uint k_trait_hub = 4u;     // a hub; in a constraint: of whose mass this is a share
const uint k_trait_asleep = 8u;  // it stays where it is, whatever pushes it in this step
const uint k_trait_moves = 16u;  // it is rigid or kinematic, and neither frozen nor asleep
const uint k_trait_loaded = 32u; // the caller pushes it in this step: what has no load need not be asked for it in each sub-step
const uint k_trait_grouped = 64u; // of an island that a work group solves
const uint k_contacts_of_body = 9u; // from this bit on, 6 of them: contacts in all colours but those of hubs
const uint k_trait_of_tall = 0x8000u; // of a multirate island in which a column is tall; in a constraint, too
const uint k_trait_whole_hub = 256u; // only in a constraint: of a hub, in a colour where that is a body as others are

// BodyProperties::combine
const uint k_combine_average = 0u;
const uint k_combine_minimum = 1u;
const uint k_combine_maximum = 2u;
const uint k_combine_multiply = 3u;

// The constraint graph: colours 0 to k_max_colours - 1, the last of them for contacts of hubs; then the overflow set, then
// pairs that do not touch.
const uint k_max_colours = 64u;
const uint k_ground_colour = 61u; // for contacts with the ground: bodies that cannot be pushed
const uint k_first_hub_colour = 62u;
const uint k_overflow_colour = 64u;
const uint k_colour_offsets = k_overflow_colour + 2u; // where each of these begins, and the end
// Behind them: where in each colour ends what has a slowness, or a lesser one, in multirate islands; of all but the last slowness.
const uint k_most_doublings = 5u; // of the fewest sub-steps
const uint k_slownesses = k_most_doublings + 1u;
const uint k_rate_ends = k_colour_offsets;
const uint k_offset_words = k_rate_ends + k_most_doublings * k_max_colours;
const uint k_inactive_colour = 127u;
const uint k_colours_of_key = k_overflow_colour + 1u; // of what is solved; keys of manifolds count them: see island.shared.glsl
const uint k_no_colour = 0xffu; // not coloured yet
const uint k_whole_hub = 0x80u; // Manifold::colour has it added where the manifold met a hub with its whole mass

// Words of the Counters buffer. "demand" counts what was wanted, also beyond a buffer's end.
const uint k_counter_body_count = 0u;
const uint k_counter_pair_demand = 1u;    // pairs of the last search, and those that have been added since
const uint k_counter_pair_count = 2u;     // 0 in a step that did not fit
const uint k_counter_manifold_count = 3u; // pairs that touch; once colours are planned, without sleeping ones
const uint k_counter_contact_count = 4u;  // contact points
const uint k_counter_colour_demand = 5u;  // colours from k_ground_colour down to the last that is in use
const uint k_counter_overflow_count = 6u; // manifolds in the overflow set
const uint k_counter_uncoloured = 7u;     // manifolds without a colour
const uint k_counter_did_not_fit = 8u;    // k_fit_* bits; sticky until the host has made room
const uint k_counter_frozen_bodies = 9u;  // in all steps so far
const uint k_counter_old_pair_count = 10u; // entries of OldManifolds
const uint k_counter_substep_demand = 11u; // most sub-steps that a manifold asks for
const uint k_counter_hub_count = 12u;
const uint k_counter_hub_manifolds = 13u; // in the colours for hubs
// Of the manifolds that are solved by launches; work groups that solve islands need none.
const uint k_counter_launched_colours = 14u;
const uint k_counter_launched_substeps = 15u; // the most; in a multirate world the ticks of a step
const uint k_counter_launched_overflow = 16u;
const uint k_counter_report_count = 17u; // contact events
const uint k_counter_sleeping_bodies = 18u;
const uint k_counter_sleeping_manifolds = 19u; // of sleeping islands: nobody solves them
// The search for pairs.
const uint k_counter_search_count = 20u;   // body slots that are searched: all, or 0 where no search of all is due
const uint k_counter_found_pairs = 21u;    // by the search
const uint k_counter_searched_slots = 22u; // body slots of the last search whose pairs there was room for
const uint k_counter_pairs_changed = 23u;  // 1 where pairs are other ones than OldManifolds has
const uint k_counter_searched = 24u;       // 1 where this step had to search all
const uint k_counter_singles = 25u; // islands with too many bodies to share a work group, and few enough for one of their own
const uint k_counter_graph_due = 26u; // not 0 where the last step's constraint graph is not this one's
const uint k_counter_graph_was_due = 27u; // 1 where this step had to make its graph
// Of what launches solve, as above: manifolds with a colour or in the overflow set, and bodies that are no hubs.
const uint k_counter_launched_manifolds = 28u;
const uint k_counter_launched_bodies = 29u;
const uint k_counter_multirate_islands = 30u; // that launches solve
// What the constraint graph is made of: all, or 0 where it is the last step's.
const uint k_counter_graph_bodies = 31u; // body slots
const uint k_counter_graph_pairs = 32u;
// The search for the pairs of a few bodies.
const uint k_counter_stray_count = 33u; // bodies that have left their boxes, until it is known that they are too many
const uint k_counter_wide_strays = 34u; // that meet too much in the tree
const uint k_counter_near_pairs = 35u;  // of strays, that are near now, and were not
const uint k_counter_added_pairs = 36u; // since the last search of all
const uint k_counter_strayed = 37u;     // 1 where this step had to search, a few bodies or all
const uint k_counter_wanted_pairs = 38u; // that the list would have with those of strays, where there is no room for them
const uint k_counter_largest_island = 39u; // in a small world: manifolds of the island that has most
const uint k_counter_listed_pairs = 40u; // of what the constraint graph is made where parts of islands sleep
const uint k_counter_same_list = 41u; // 1 where the last step had the pairs of the one before
const uint k_counter_pairs_to_collide = 42u; // whose contacts do not last
const uint k_counter_awake = 43u; // 1 where a body is awake, or moves as its caller says; only while islands may sleep
const uint k_counter_all_strays = 44u; // since the last search of all
const uint k_counter_searched_tree = 45u; // 1 where strays of this step searched the tree
const uint k_counter_low_islands = 46u; // multirate ones that launches solve, without a tall column
const uint k_counter_ordered_pairs = 47u; // that the last constraint graph was made of
const uint k_counter_doubtful = 48u; // manifolds that have kept a colour which they may give up
const uint k_counter_given_up = 49u; // those that have
const uint k_counter_words = 50u;

// Bits of k_counter_did_not_fit
const uint k_fit_pairs = 1u;
const uint k_fit_colours = 2u;
const uint k_fit_substeps = 4u;
const uint k_fit_hubs = 8u;
const uint k_fit_search = 16u; // no room is missing: a driver ended the search for pairs
const uint k_fit_reports = 32u; // the step itself is done; those behind it wait until its reports have been fetched
const uint k_fit_groups = 64u; // groups that wait for each other, or invocations of one, were not run side by side: the step went wrong
const uint k_fit_strays = 128u; // no room is missing: bodies had left their boxes, and the search had no launches
const uint k_fit_graph = 256u; // no room is missing: the step had to make its constraint graph, and had no launches for it
const uint k_fit_manifolds = 512u; // that are solved
const uint k_fit_all = 1024u; // no room is missing: the step had to search for all pairs, or strays the tree, and had no launches for it

// Which search for pairs has launches.
const uint k_search_none = 0u;
const uint k_search_strays = 1u;
const uint k_search_all = 2u;

// Bodies that are searched for by themselves where they have left their boxes; where there are more, all are.
const uint k_compared_strays = 64u;    // with all bodies, one by one
const uint k_share_of_strays = 8u;     // of the bodies, where these are in a tree
const uint k_near_a_stray = 4u;        // that it was not near to, of all strays together
const uint k_most_near_pairs = 16384u; // of all
const uint k_most_new_pairs = 2048u;   // that are not in the list, in a step
const uint k_share_added = 32u;        // of the pairs; where more have been added, all are searched for

// In k_counter_graph_due: nor will this step's be the next one's. A body that has become a hub keeps the colours of its old
// contacts for one step.
const uint k_due_twice = 2u;
// Or: contacts of hubs may get other colours. The graph is made if it has launches for that, but is no reason to give it some.
const uint k_due_for_hubs = 3u;

// Entries of the Dispatches buffer. Those of the detection come first; the others are empty after a step that did not
// fit, so that nothing of the state is written.
const uint k_dispatch_pairs = 0u;      // groups of 64 pairs
const uint k_dispatch_old_pairs = 1u;  // groups of 64 pairs of the last step, where they have to be looked up by their bodies
const uint k_dispatch_bodies = 2u;     // groups of 64 bodies, one where there are none: a step counts pairs all the same
const uint k_dispatch_ordered_pairs = 3u; // groups of 64 pairs that the graph of this step was made of, in this or an earlier one
const uint k_dispatch_islands = 4u;    // a group for each body slot, which may lead an island, or for each group of islands
const uint k_dispatch_colours = 5u;    // groups of 64 manifolds of colour 0, then of colour 1, ...
const uint k_dispatch_overflow = k_dispatch_colours + k_max_colours; // one group if there is an overflow set
const uint k_dispatch_hubs = k_dispatch_overflow + 1u; // one group for each hub
const uint k_dispatch_reports = k_dispatch_hubs + 1u; // groups of 64 pairs, for contact events
const uint k_dispatch_report_ends = k_dispatch_reports + 1u; // groups of 64 pairs of the last step
const uint k_dispatch_graph_pairs = k_dispatch_report_ends + 1u; // groups of 64 pairs, where a constraint graph is made
const uint k_dispatch_graph_tiles = k_dispatch_graph_pairs + 1u; // sort tiles of them
const uint k_dispatch_graph_counts = k_dispatch_graph_tiles + 1u; // groups of k_count_group of them
const uint k_dispatch_table = k_dispatch_graph_counts + 1u; // groups of 64 slots of PairTable, where pairs have to be looked up
const uint k_dispatch_count = k_dispatch_table + 1u;

const uint k_block_records = 32u; // see device/gl/record_blocks.h
const uint k_group_size = 64u;   // invocations a group of kernels that treat one item each
const uint k_sort_tile = 1024u;  // keys that one group sorts
const uint k_digits = 256u;      // values of the sort's digit
const uint k_spread_group = 256u; // bodies that one group sums
const uint k_count_group = 1024u; // pairs that one group counts: what groups add up waits for one word, 5 ns for each
const uint k_mark_group = 256u;    // pairs whose marks are counted together
const uint k_mark_words = k_mark_group / 32u; // of a bit for each of them
// Of Arrivals, see primitives/grid_barrier.glsl.
const uint k_all_fastest_bodies = 3u;    // the word with how many bodies of a multirate solve are listed from the front
const uint k_all_other_fast_bodies = 4u; // and from the end of their list
const uint k_arrival_words = 5u;
const uint k_hub_group = 256u;   // changes of a hub that are summed side by side
const uint k_island_bodies = 1024u; // body slots of a world that is solved island by island
// In a larger world a work group solves several islands: those that begin within a window of so many bodies, in the order
// of islands. It has room for them, and for the rest of the last one. Stacks have a manifold a body, and of 2, 3, 4, 5, 6 or
// 10 bodies they fill the window: one manifold for each of 60 of the group's 64 invocations.
const uint k_group_window = 60u;
const uint k_most_grouped = 196u; // bodies of an island that a group can solve
const uint k_group_room = k_group_window + k_most_grouped; // bodies
const uint k_least_multirate = 65536u; // bodies of an island whose contacts may differ in sub-steps
const uint k_most_single = k_island_bodies; // bodies of an island that has a group of its own
// In shared memory, each for the velocity or the movement of a body, where contacts of a group wait one by one: for both of 681
// bodies of a single island, or body slots of a small world, and for the velocities of more.
const uint k_shared_places = 1364u;

// Words of a body in ToldLoads, see resolution/load.shared.glsl.
const uint k_told_mass = 0u;
const uint k_told_height = 1u;
const uint k_told_words = 2u;
