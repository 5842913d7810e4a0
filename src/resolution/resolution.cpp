// SPDX-License-Identifier: MIT
// The launches of the resolution, in order.
#include "resolution/resolution.h"

#include <algorithm>
#include <bit>

#include "primitives/primitives.h"
#include "resolution/contact_passes.h"
#include "state/formulas.h"
#include "step.h"

namespace talus::engine {

// Of the largest key, that of pairs that do not touch. Islands have the numbers of their body slots.
static uint manifold_key_bits(const StepPlan& plan) {
    uint largest = k_inactive_colour;
    if (plan.small && plan.in_groups) largest = manifold_key(k_island_bodies, k_inactive_colour);
    if (plan.measures_islands()) largest = inactive_key(plan.body_count);
    return std::bit_width(largest);
}

/// Who sleeps, for which islands are found of all that contacts can push; and which pairs the graph is made of then:
/// those of what is awake, and those of sleepers that something awake touches.
static void choose_who_sleeps(Device& device, const StepPlan& plan, SortPlace spare) {
    device.run({.kernel = join_islands, .slot = k_dispatch_graph_pairs, .args = {k_join_to_sleep}});
    device.run({.kernel = measure_islands, .items = plan.body_count, .args = {1}});
    device.run(
        {.kernel = choose_sleepers, .items = plan.body_count, .args = {plan.least_multirate, plan.may_be_multirate()}});
    device.run({.kernel = begin_awake, .items = plan.body_count});
    device.run({.kernel = press_sleepers, .slot = k_dispatch_graph_pairs});
    const BufferId counts = spare.keys, bits = spare.values; // nothing lies there yet
    const std::size_t groups = (plan.pair_capacity + k_mark_group - 1) / k_mark_group;
    device.grow(bits, k_mark_words * groups * sizeof(uint));
    const std::initializer_list<Binding> marks{{"MarkCounts", counts}, {"Marks", bits}};
    device.run({.kernel = mark_awake_pairs, .slot = k_dispatch_graph_counts, .bindings = marks});
    exclusive_scan(device, counts, plan.pair_capacity, k_counter_graph_pairs, k_counter_listed_pairs, k_mark_group);
    device.run({.kernel = list_awake_pairs, .items = (plan.pair_capacity + 31) / 32, .bindings = marks});
}

/// The islands of a large world, and which of them a work group solves. `colours`: of pairs.
static void find_island_groups(Device& device, const StepPlan& plan, BufferId keys, BufferId colours) {
    const uint joined = plan.sleeps_in_parts() ? k_join_awake : k_join_all;
    const auto join = [&](uint part) {
        device.run({.kernel = join_islands, .slot = k_dispatch_graph_pairs, .args = {joined, part}});
    };
    // Quicker in a large heap: 0.32 instead of 0.57 ms for `million`; not with half as many bodies in `brick_gables`.
    if (plan.body_count >= plan.joined_twice) {
        join(k_pairs_first);
        device.run({.kernel = shorten_paths, .items = plan.body_count});
        join(k_pairs_others);
    } else {
        join(k_pairs_all);
    }
    device.run({.kernel = measure_islands, .items = plan.body_count});
    exclusive_scan(device, BufferId::IslandStarts, plan.body_count, k_counter_graph_bodies, k_none);
    device.run({.kernel = group_islands,
                .items = plan.body_count,
                .args = {plan.has_groups(), plan.singles, plan.multirate_from(), plan.sleeps_in_parts()}});
    device.run({.kernel = key_manifolds,
                .slot = k_dispatch_graph_pairs,
                .args = {plan.sleeps_in_parts()},
                .bindings = {{"Keys", keys}, {"ManifoldKeys", colours}}});
}

void wake(Device& device, const StepPlan& plan) {
    if (plan.waking == Waking::None) return;
    device.run({.kernel = wake_bodies, .items = plan.body_count, .args = {plan.waking == Waking::All}});
    device.run({.kernel = wake_neighbours, .items = plan.pair_capacity});
}

// What it launches does nothing in a step whose graph is still the last one's. ManifoldKeys of kernels before the sort
// are where the sort begins.
static void make_graph(Device& device, const StepPlan& plan) {
    const Sort order{.keys = BufferId::ManifoldKeys,
                     .values = BufferId::ManifoldPlaces,
                     .capacity = plan.pair_capacity,
                     .count_counter = k_counter_graph_pairs,
                     .bits = manifold_key_bits(plan),
                     .slot = k_dispatch_graph_tiles,
                     .gives_places = true};
    if (plan.sleeps_in_parts()) device.grow(BufferId::ListedPairs, plan.pair_capacity * sizeof(uint));
    const BufferId keys = unsorted_place(device, order).keys;
    // Of listed pairs the colours lie at the pairs, and the keys in the order of the list.
    const BufferId colours = plan.sleeps_in_parts() ? spare_place(device, order).keys : keys;
    const bool measures_islands = plan.measures_islands();
    device.run({.kernel = begin_graph,
                .items = std::max(plan.body_count, 1u),
                .args = {measures_islands, plan.sleeps_in_parts()}});
    if (plan.sleeps_in_parts()) choose_who_sleeps(device, plan, spare_place(device, order));
    device.run({.kernel = keep_colours,
                .slot = k_dispatch_graph_counts,
                .args = {plan.sleeps_in_parts()},
                .bindings = {{"ManifoldKeys", colours}}});
    // Colours and islands are found beside each other.
    device.run({.kernel = assign_colours,
                .items = plan.colouring_groups,
                .args = {0, plan.sleeps_in_parts()},
                .bindings = {{"ManifoldKeys", colours}},
                .overlaps_next = measures_islands});
    if (plan.small)
        device.run({.kernel = find_islands,
                    .items = 1,
                    .args = {plan.one_island, plan.in_groups},
                    .bindings = {{"ManifoldKeys", keys}}});
    if (measures_islands) find_island_groups(device, plan, keys, colours);
    sort_by_key(device, order);
}

void constraint_graph(Device& device, const StepPlan& plan) {
    if (plan.makes_graph)
        make_graph(device, plan);
    else if (plan.hub_capacity > 0)
        device.run({.kernel = weigh_hubs, .items = plan.weighing_groups});
    device.run({.kernel = plan_colours,
                .items = 1,
                .args = {plan.measures_islands(), plan.needs_launches(), !plan.makes_graph, plan.overflow}});
}

std::size_t records_with_hits(uint bodies, uint manifolds) {
    static_assert(sizeof(BodyHits) == sizeof(BodyWarmStart));
    return std::size_t{contact_hits_place(manifolds, bodies)} + 1;
}

uint words_of_fast_bodies(const StepPlan& plan) {
    if (!plan.may_be_multirate()) return 0;
    return fast_body_words(plan.fewest_substeps(), plan.most_substeps) * plan.body_count;
}

/// What only some worlds need for the solve, where a simulation has not made room for it: what hits have to know of
/// bodies and contacts, behind the warm starts; and what bodies of a multirate island have to know in the persistent
/// launch.
static void reserve_for_solve(Device& device, const StepPlan& plan) {
    if (plan.bounces)
        device.grow(BufferId::WarmStarts,
                    records_with_hits(plan.body_count, plan.manifold_capacity) * sizeof(BodyWarmStart));
    if (plan.persistent_groups > 0 && plan.needs_launches())
        device.grow(BufferId::FastBodies, words_of_fast_bodies(plan) * sizeof(uint));
}

void prepare(Device& device, const StepPlan& plan) {
    reserve_for_solve(device, plan); // may throw, and what follows cannot be undone
    device.place_constraints(plan.constraints_beside ? ConstraintPlace::BesideContacts
                                                     : ConstraintPlace::OverOldContacts);
    device.run({.kernel = prepare_bodies,
                .slot = k_dispatch_bodies,
                .args = {plan.has_islands(), plan.has_groups(), plan.bounces,
                         (plan.records_last ? k_with_records : 0u) | (plan.sleeps_in_parts() ? k_with_parts : 0u) |
                             (plan.loads ? k_with_loads : 0u)}});
    device.run(
        {.kernel = prepare_contacts, .slot = k_dispatch_ordered_pairs, .args = {plan.sleeps_in_parts(), plan.bounces}});
}

/// One pass over all manifolds that have a sub-step at this tick, colour by colour; those of hubs and the overflow set
/// come last.
static void pass_over_contacts(Device& device, const StepPlan& plan, ContactPass pass, uint tick) {
    const auto launch = [&](const Kernel& kernel, uint colour, uint slot) {
        device.run({.kernel = kernel, .slot = slot, .args = {colour, static_cast<uint>(pass), tick}});
    };
    for (uint colour = k_first_hub_colour - plan.colour_capacity; colour < k_first_hub_colour; ++colour)
        launch(solve_contacts, colour, k_dispatch_colours + colour);
    for (uint colour = k_first_hub_colour; plan.hub_capacity > 0 && colour < k_max_colours; ++colour) {
        launch(solve_hub_contacts, colour, k_dispatch_colours + colour);
        launch(move_hubs, colour, k_dispatch_hubs);
    }
    if (plan.overflow) launch(solve_contacts, k_overflow_colour, k_dispatch_overflow);
}

const Kernel& persistent_solver(const StepPlan& plan) {
    return plan.may_be_multirate() ? solve_multirate : solve_persistent;
}

const Kernel& group_solver(const StepPlan& plan) {
    if (plan.small) return plan.bounces ? solve_bouncing_islands : solve_islands;
    return plan.bounces ? solve_bouncing_groups : solve_island_groups;
}

const Kernel& single_solver(const StepPlan& plan) {
    return plan.bounces ? solve_bouncing_singles : solve_single_islands;
}

void solve(Device& device, const StepPlan& plan) {
    // Each solves other islands. The persistent launch comes first, as all its groups have to run at a time.
    const Kernel& persistent = persistent_solver(plan);
    if (plan.persistent_groups > 0 && plan.needs_launches())
        device.run({.kernel = persistent,
                    .items = plan.persistent_groups * persistent.items_a_group,
                    .args = {0, plan.kinematic},
                    .overlaps_next = plan.in_groups});
    if (plan.in_groups) {
        if (plan.singles)
            device.run({.kernel = single_solver(plan),
                        .slot = k_dispatch_islands,
                        .args = {plan.bounces},
                        .overlaps_next = true});
        device.run({.kernel = group_solver(plan), .slot = k_dispatch_islands, .args = {plan.bounces}});
    }
    if (!plan.needs_launches() || plan.substep_capacity == 0 || plan.persistent_groups > 0) return;
    for_each_pass(
        plan.substep_capacity, plan.iterations, plan.relax,
        [&](uint tick) {
            device.run({.kernel = integrate_bodies, .slot = k_dispatch_bodies, .args = {tick, plan.bounces}});
        },
        [&](ContactPass pass, uint tick) { pass_over_contacts(device, plan, pass, tick); });
}

void store_impulses(Device& device, const StepPlan& plan) {
    // What ends the step for bodies needs nothing of it; contact events do, and what weighs on sleepers.
    const bool is_awaited = plan.watch != ContactWatch::None || plan.sleeps_in_parts();
    device.run({.kernel = store_contact_impulses,
                .slot = k_dispatch_ordered_pairs,
                .args = {plan.sleeps_in_parts(), plan.bounces, plan.may_be_multirate()},
                .overlaps_next = !is_awaited});
}

} // namespace talus::engine
