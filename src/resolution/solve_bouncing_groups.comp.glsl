// SPDX-License-Identifier: MIT
// Solves the groups of islands of a large world in which something may bounce. See solve_island_groups.glsl.
const bool k_bounces = true;
#include "resolution/solve_island_groups.glsl"
#include "resolution/stored_hits.glsl"
