// SPDX-License-Identifier: MIT
// Resolution: manifolds -> velocities and movements, by sequential impulses over coloured batches (thesis,
// section 3.4).
#pragma once

#include "device/device.h"

namespace talus::engine {

struct StepPlan;

/// Wakes what the caller has changed, and what touched it. Before the broad phase.
void wake(Device&, const StepPlan&);
/// Colours every manifold: no two of one colour share a body that contacts can push. Divides the world into islands
/// besides, as these are independent.
void constraint_graph(Device&, const StepPlan&);
/// Effective masses and the solver's records, in the order of colours.
void prepare(Device&, const StepPlan&);
/// All sub-steps.
void solve(Device&, const StepPlan&);
/// Impulses and colours go back to the manifolds, for the next step's warm start.
void store_impulses(Device&, const StepPlan&);
/// Room for what hits have to know of bodies and contacts: records of WarmStarts, behind those of all bodies, that
/// these included.
std::size_t records_with_hits(uint bodies, uint manifolds);
/// Room for what bodies of multirate islands have to know in the persistent launch: words of FastBodies.
uint words_of_fast_bodies(const StepPlan&);
/// The kernel that makes all passes in one launch.
const Kernel& persistent_solver(const StepPlan&);
/// The kernel whose work groups solve islands: each of a small world, or the little ones of a large world.
const Kernel& group_solver(const StepPlan&);
/// The one whose work groups solve an island of middling size each.
const Kernel& single_solver(const StepPlan&);

extern const Kernel begin_graph;
extern const Kernel keep_colours;
extern const Kernel assign_colours;
extern const Kernel weigh_hubs;
extern const Kernel find_islands;
extern const Kernel join_islands;
extern const Kernel shorten_paths;
extern const Kernel measure_islands;
extern const Kernel choose_sleepers;
extern const Kernel begin_awake;
extern const Kernel press_sleepers;
extern const Kernel mark_awake_pairs;
extern const Kernel list_awake_pairs;
extern const Kernel group_islands;
extern const Kernel key_manifolds;
extern const Kernel plan_colours;
extern const Kernel prepare_bodies;
extern const Kernel prepare_contacts;
extern const Kernel integrate_bodies;
extern const Kernel solve_contacts;
extern const Kernel solve_hub_contacts;
extern const Kernel move_hubs;
extern const Kernel solve_islands;
extern const Kernel solve_bouncing_islands;
extern const Kernel solve_island_groups;
extern const Kernel solve_bouncing_groups;
extern const Kernel solve_single_islands;
extern const Kernel solve_bouncing_singles;
extern const Kernel solve_persistent;
extern const Kernel solve_multirate;
extern const Kernel store_contact_impulses;
extern const Kernel wake_bodies;
extern const Kernel wake_neighbours;

} // namespace talus::engine
