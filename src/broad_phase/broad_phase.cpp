// SPDX-License-Identifier: MIT
// The launches of the broad phase, in order.
#include "broad_phase/broad_phase.h"

#include "primitives/primitives.h"
#include "step.h"

namespace talus::engine {

static void sort_along_widest_axis(Device& device, uint body_count) {
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

// Counting first gives each body's pairs a place that does not depend on who comes first.
static void find_pairs(Device& device, const Kernel& kernel, uint body_count) {
    constexpr uint count = 0, write = 1;
    device.run({.kernel = kernel, .items = body_count, .args = {count}});
    exclusive_scan(device, BufferId::PairCounts, body_count, k_counter_body_count, k_counter_pair_demand);
    device.run({.kernel = kernel, .items = body_count, .args = {write}});
}

void broad_phase(Device& device, const StepPlan& plan) {
    if (plan.broad_phase == BroadPhase::Brute) {
        device.run({.kernel = update_aabbs, .items = plan.body_count});
        find_pairs(device, test_all_pairs, plan.body_count);
    } else if (plan.small) {
        device.run({.kernel = order_bodies, .items = 1});
        device.run({.kernel = sweep_in_group, .items = 1});
    } else {
        device.run({.kernel = update_aabbs, .items = plan.body_count});
        sort_along_widest_axis(device, plan.body_count);
        find_pairs(device, sweep_pairs, plan.body_count);
    }
    device.run({.kernel = plan_pairs, .items = 1});
}

} // namespace talus::engine
