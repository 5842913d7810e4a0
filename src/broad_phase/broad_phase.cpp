// SPDX-License-Identifier: MIT
// The launches of the broad phase, in order.
#include "broad_phase/broad_phase.h"

#include "primitives/primitives.h"
#include "step.h"

namespace talus::engine {

static void sort_along_widest_axis(Device& device, const StepPlan& plan) {
    const uint body_count = plan.body_count;
    if (plan.by_island) return device.run({.kernel = order_bodies, .items = 1});
    device.run({.kernel = update_aabbs, .items = body_count});
    device.run({.kernel = measure_spread, .items = body_count});
    device.run({.kernel = choose_axis, .items = 1});
    device.run({.kernel = write_sort_keys, .items = body_count});
    sort_by_key(device, {.keys = BufferId::SortKeys,
                         .values = BufferId::SortValues,
                         .keys_swap = BufferId::SortKeysSwap,
                         .values_swap = BufferId::SortValuesSwap,
                         .capacity = body_count,
                         .count_counter = k_counter_body_count});
    device.run({.kernel = gather_aabbs, .items = body_count});
}

void broad_phase(Device& device, const StepPlan& plan) {
    const uint body_count = plan.body_count;
    const bool sweep = plan.broad_phase == BroadPhase::SweepAndPrune;
    if (sweep)
        sort_along_widest_axis(device, plan);
    else
        device.run({.kernel = update_aabbs, .items = body_count});

    // Counting first gives each body's pairs a place that does not depend on who comes first.
    const Kernel& find_pairs = sweep ? sweep_pairs : test_all_pairs;
    constexpr uint count = 0, write = 1;
    device.run({.kernel = find_pairs, .items = body_count, .args = {count}});
    exclusive_scan(device, BufferId::PairCounts, body_count, k_counter_body_count, k_counter_pair_demand);
    device.run({.kernel = find_pairs, .items = body_count, .args = {write}});
    device.run({.kernel = plan_pairs, .items = 1});
}

} // namespace talus::engine
