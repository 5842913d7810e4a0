// SPDX-License-Identifier: MIT
// Every buffer of the state, in one table. A kernel names the buffers that it uses by their block name; its CPU twin
// finds them under the field name in CpuState.
#pragma once

#include <array>
#include <cstddef>

#include "state/dialect.h"

namespace talus::engine {

#include "state/constants.shared.glsl"
#include "state/records.shared.glsl"

// X(block, field, element, layout, role)
//   layout  the element's words: f float, u uint
//   role    State    survives the step, and is the same on every device
//           Result   made anew in each step, those of the search for pairs where it is due; the same on every device
//           Scratch  made anew in each step, in an order or at places that may differ between runs
#define TALUS_BUFFERS(X)                                                                                               \
    /* bodies */                                                                                                       \
    X(Poses, poses, BodyPose, "fffuffff", State)                                                                       \
    X(Velocities, velocities, BodyVelocity, "fffffffu", State)                                                         \
    X(Shapes, shapes, BodyShape, "fffu", State)                                                                        \
    X(Properties, properties, BodyProperties, "fffffffffuuu", State)                                                   \
    X(Loads, loads, BodyLoad, "fffuffff", State)                                                                       \
    X(Rests, rests, BodyRest, "fffuffff", State)                                                                       \
    X(Starts, starts, BodyStart, "fffu", State)                                                                        \
    X(Changes, changes, uint, "u", Scratch)                                                                            \
    /* broad phase */                                                                                                  \
    X(OrientedBoxes, oriented_boxes, OrientedBox, "fffffffffffu", State)                                               \
    X(Aabbs, aabbs, Aabb, "fffffffu", Result)                                                                          \
    X(SpreadSums, spread_sums, SpreadSum, "ffffffffffff", Result)                                                      \
    X(SweepAxes, sweep_axes, SweepAxis, "ufuu", Result)                                                                \
    X(SortKeys, sort_keys, uint, "u", Result)                                                                          \
    X(SortValues, sort_values, uint, "u", Result)                                                                      \
    X(SwapKeys, swap_keys, uint, "u", Scratch)                                                                         \
    X(SwapValues, swap_values, uint, "u", Scratch)                                                                     \
    X(DigitCounts, digit_counts, uint, "u", Scratch)                                                                   \
    X(SortedAabbs, sorted_aabbs, Aabb, "fffffffu", Result)                                                             \
    X(TreeGrids, tree_grids, TreeGrid, "fffffuuu", Result)                                                             \
    X(TreeNodes, tree_nodes, Aabb, "fffffffu", Result)                                                                 \
    X(PairCounts, pair_counts, uint, "u", Result)                                                                      \
    X(ScanSums, scan_sums, uint, "u", Scratch)                                                                         \
    X(Pairs, pairs, Pair, "uu", State)                                                                                 \
    X(Strays, strays, uint, "u", Scratch)                                                                              \
    X(WideStrays, wide_strays, uint, "u", Scratch)                                                                     \
    X(NearPairs, near_pairs, Pair, "uu", Scratch)                                                                      \
    X(NearTable, near_table, uint, "u", Scratch)                                                                       \
    /* narrow phase */                                                                                                 \
    X(PairTable, pair_table, uint, "u", Scratch)                                                                       \
    X(OldManifolds, old_manifolds, Manifold, "uuuufffufffffffu", State)                                                \
    X(OldManifoldPoints, old_manifold_points, ManifoldPoint, "fffu", State)                                            \
    X(OldPointSeparations, old_point_separations, Separations, "ffffffff", State)                                      \
    X(OldPointImpulses, old_point_impulses, NormalImpulses, "ffff", State)                                             \
    X(Manifolds, manifolds, Manifold, "uuuufffufffffffu", Result)                                                      \
    X(ManifoldPoints, manifold_points, ManifoldPoint, "fffu", Result)                                                  \
    X(PointSeparations, point_separations, Separations, "ffffffff", Result)                                            \
    X(PointImpulses, point_impulses, NormalImpulses, "ffff", Result)                                                   \
    /* resolution */                                                                                                   \
    X(Islands, islands, uint, "u", Result)                                                                             \
    X(Substeps, substeps, uint, "u", Result)                                                                           \
    X(IslandSizes, island_sizes, uint, "u", Result)                                                                    \
    X(IslandStarts, island_starts, uint, "u", Result)                                                                  \
    X(IslandGroups, island_groups, uint, "u", Result)                                                                  \
    X(IslandFill, island_fill, uint, "u", Scratch)                                                                     \
    X(IslandBodies, island_bodies, uint, "u", Scratch)                                                                 \
    X(IslandPlaces, island_places, uint, "u", Scratch)                                                                 \
    X(BodyColours, body_colours, uint, "u", Scratch)                                                                   \
    X(Uncoloured, uncoloured, uint, "u", Scratch)                                                                      \
    X(ManifoldKeys, manifold_keys, uint, "u", Result)                                                                  \
    X(ManifoldPlaces, manifold_places, uint, "u", Result)                                                              \
    X(ListedPairs, listed_pairs, uint, "u", Result)                                                                    \
    X(ColourOffsets, colour_offsets, uint, "u", Result)                                                                \
    X(LaunchedBodies, launched_bodies, uint, "u", Scratch)                                                             \
    X(Inertias, inertias, BodyInertia, "ffffffuu", Result)                                                             \
    X(WarmStarts, warm_starts, BodyWarmStart, "ffffffff", Result)                                                      \
    X(Deltas, deltas, BodyDelta, "ffffffff", Result)                                                                   \
    X(Constraints, constraints, ContactConstraint, "uuuufffffffffffffffuffffffffffffffffffffffffffffffffffffffff",     \
      Result)                                                                                                          \
    X(ToldLoads, told_loads, uint, "u", Result)                                                                        \
    X(Balances, balances, uint, "u", Scratch)                                                                          \
    X(FastBodies, fast_bodies, uint, "u", Scratch)                                                                     \
    X(Hubs, hubs, uint, "u", Scratch)                                                                                  \
    X(HubChanges, hub_changes, HubChange, "fffufffu", Result)                                                          \
    X(Arrivals, arrivals, uint, "u", Scratch)                                                                          \
    /* finish */                                                                                                       \
    X(ContactImpulses, contact_impulses, ContactImpulse, "ffff", Result)                                               \
    X(ContactStates, contact_states, uint, "u", Result)                                                                \
    X(OldContactStates, old_contact_states, uint, "u", State)                                                          \
    X(ContactReports, contact_reports, ContactReport, "uuuufffuffffffffffffffffffff", Scratch)                         \
    /* control */                                                                                                      \
    X(Counters, counters, uint, "u", State)                                                                            \
    X(Dispatches, dispatches, Dispatch, "uuuu", Result)

} // namespace talus::engine
