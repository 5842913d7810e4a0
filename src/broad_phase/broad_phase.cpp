// SPDX-License-Identifier: MIT
// The launches of the broad phase, in order.
#include "broad_phase/broad_phase.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "log.h"
#include "primitives/primitives.h"
#include "state/formulas.h"
#include "step.h"

namespace talus::engine {

// Nobody wants the list of launched bodies before the resolution makes it.
static constexpr std::initializer_list<Binding> k_marks{{"StrayMarks", BufferId::LaunchedBodies}};

// The order stays in SortValues until the next search of all, also where this is launched and sorts nobody.
static void sort_bodies(Device& device, uint body_count) {
    sort_by_key(device, {.keys = BufferId::SortKeys,
                         .values = BufferId::SortValues,
                         .capacity = body_count,
                         .count_counter = k_counter_search_count});
}

static void sort_along_widest_axis(Device& device, uint body_count) {
    device.run({.kernel = measure_spread, .items = body_count});
    device.run({.kernel = choose_axis, .items = 1});
    device.run({.kernel = write_sort_keys, .items = body_count});
    sort_bodies(device, body_count);
    device.run({.kernel = gather_aabbs, .items = body_count});
}

static uint body_capacity(const Device& device) {
    return static_cast<uint>(device.size(BufferId::Aabbs) / sizeof(Aabb));
}

std::vector<uint> order_in_tree(std::span<const Aabb> boxes) {
    SpreadSum sum = empty_spread();
    for (const Aabb& box : boxes)
        sum = add_spreads(sum, spread_of(box));
    const TreeGrid grid = choose_tree_grid(sum, static_cast<uint>(boxes.size()));
    std::vector<std::pair<uint, uint>> keys; // and the slots
    for (const Aabb& box : boxes)
        keys.emplace_back(tree_key(box, grid), static_cast<uint>(keys.size()));
    std::ranges::sort(keys);
    std::vector<uint> order(keys.size());
    std::ranges::transform(keys, order.begin(), &std::pair<uint, uint>::second);
    return order;
}

uint boxes_of_search(uint body_capacity) {
    // Children are looked at by fours, also where the last ones are not there.
    const uint leaves = body_capacity + k_tree_children - 1;
    return tree_node(0, 0, tree_top(body_capacity)) + leaves;
}

// Where it is no part of the room of contacts, only worlds that use the tree have room for it, as much as for bodies.
static void reserve_tree(Device& device) {
    device.grow(BufferId::TreeNodes, boxes_of_search(body_capacity(device)) * sizeof(Aabb));
}

// And only those that sweep, for boxes in order.
static void reserve_sweep(Device& device) {
    device.grow(BufferId::SortedAabbs, std::size_t{body_capacity(device)} * sizeof(Aabb));
}

/// Of the bodies as they are in order; or for strays, of all in the order of the last search.
static void build_tree_of(Device& device, uint body_count, uint top, bool for_strays) {
    const uint highest = for_strays ? strays_begin_at(body_count) : top;
    uint shift = 0;
    do {
        device.run({.kernel = build_tree,
                    .items = tree_level_size(body_count, shift),
                    .args = {shift, top, for_strays},
                    .bindings = k_marks});
        shift += k_tree_shift;
    } while (shift < highest);
}

static void make_tree(Device& device, uint body_count, uint top) {
    device.run({.kernel = measure_spread, .items = body_count});
    device.run({.kernel = choose_grid, .items = 1});
    device.run({.kernel = write_tree_keys, .items = body_count});
    sort_bodies(device, body_count);
    build_tree_of(device, body_count, top, false);
}

// Counting first gives each body's pairs a place that does not depend on who comes first.
static void find_pairs(Device& device, const Kernel& kernel, uint body_count, uint tree_top = 0) {
    constexpr uint count = 0, write = 1;
    // What the search of a tree remembers lies where the narrow phase, behind it, has its table.
    const std::initializer_list<Binding> bindings{{"Partners", BufferId::PairTable}};
    device.run({.kernel = kernel, .items = body_count, .args = {count, tree_top}, .bindings = bindings});
    exclusive_scan(device, BufferId::PairCounts, body_count, k_counter_search_count, k_counter_found_pairs);
    device.run({.kernel = kernel, .items = body_count, .args = {write, tree_top}, .bindings = bindings});
}

static void search_all(Device& device, const StepPlan& plan) {
    device.run({.kernel = update_aabbs, .items = plan.body_count});
    if (plan.broad_phase == BroadPhase::Brute) {
        find_pairs(device, test_all_pairs, plan.body_count);
    } else if (plan.broad_phase == BroadPhase::Bvh) {
        const uint top = tree_top(plan.body_count);
        reserve_tree(device);
        TALUS_ASSERT(device.size(BufferId::PairTable) >= std::size_t{k_kept_partners} * plan.body_count * sizeof(uint),
                     "there is no room for the partners of bodies");
        make_tree(device, plan.body_count, top);
        find_pairs(device, search_tree, plan.body_count, top);
    } else {
        reserve_sweep(device);
        sort_along_widest_axis(device, plan.body_count);
        find_pairs(device, sweep_pairs, plan.body_count);
    }
}

static void search_for_strays(Device& device, const StepPlan& plan, bool has_tree) {
    const bool with_tree = has_tree && plan.search == Search::All;
    if (with_tree) {
        const uint top = tree_top(plan.body_count);
        reserve_tree(device);
        build_tree_of(device, plan.body_count, top, true);
        device.run({.kernel = search_strays,
                    .items = most_strays(plan.body_count, has_tree),
                    .args = {strays_begin_at(plan.body_count), top},
                    .bindings = k_marks});
    }
    constexpr uint most_items = 1u << 17; // each group has a beginning to make
    device.run({.kernel = compare_strays,
                .items = std::min(plan.body_count, most_items),
                .args = {has_tree},
                .bindings = k_marks});
    device.run({.kernel = find_known_pairs, .items = plan.pair_capacity, .bindings = k_marks});
    device.run({.kernel = add_pairs, .items = 1});
    device.run({.kernel = update_aabbs, .items = most_strays(plan.body_count, has_tree), .args = {1, with_tree}});
}

// What it launches does nothing in a step whose pairs are still those of the last search, or where a smaller search
// does.
static void search(Device& device, const StepPlan& plan) {
    const bool has_tree = plan.broad_phase == BroadPhase::Bvh;
    device.run({.kernel = find_strays, .items = plan.body_count, .args = {has_tree}, .bindings = k_marks});
    if (plan.search == Search::None) return;
    search_for_strays(device, plan, has_tree);
    if (plan.search != Search::All) return;
    if (plan.sweeps_in_group()) {
        reserve_sweep(device);
        device.run({.kernel = order_bodies, .items = 1});
        device.run({.kernel = sweep_in_group, .items = 1});
    } else {
        search_all(device, plan);
    }
}

void broad_phase(Device& device, const StepPlan& plan) {
    search(device, plan);
    const uint other_graph = plan.other_graph ? 1
                             : plan.sleeping  ? 2
                                              : 0; // who sleeps is found anew while any is awake
    device.run(
        {.kernel = plan_pairs,
         .items = 1,
         .args = {static_cast<uint>(plan.search), plan.makes_graph, other_graph, plan.watch != ContactWatch::None}});
}

} // namespace talus::engine
