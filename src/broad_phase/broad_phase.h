// SPDX-License-Identifier: MIT
// Broad phase: boxes -> candidate pairs (thesis, section 3.2).
#pragma once

#include <span>
#include <vector>

#include "device/device.h"

namespace talus::engine {

struct StepPlan;

/// Fills Pairs, and Counters[k_counter_pair_count] with their number.
void broad_phase(Device&, const StepPlan&);

/// Room for those that a search of so many body slots puts in order, in either way: records of TreeNodes or
/// SortedAabbs.
uint boxes_of_search(uint body_capacity);

/// The slots of bodies in an order for the tree. What a search of all makes is as good, and is the same on every
/// device.
std::vector<uint> order_in_tree(std::span<const Aabb> boxes);

extern const Kernel find_strays;
extern const Kernel search_strays;
extern const Kernel compare_strays;
extern const Kernel find_known_pairs;
extern const Kernel add_pairs;
extern const Kernel update_aabbs;
extern const Kernel order_bodies;
extern const Kernel gather_aabbs;
extern const Kernel measure_spread;
extern const Kernel choose_axis;
extern const Kernel write_sort_keys;
extern const Kernel sweep_pairs;
extern const Kernel sweep_in_group;
extern const Kernel choose_grid;
extern const Kernel write_tree_keys;
extern const Kernel build_tree;
extern const Kernel search_tree;
extern const Kernel test_all_pairs;
extern const Kernel plan_pairs;

} // namespace talus::engine
