// SPDX-License-Identifier: MIT
// Solves the groups of islands of a large world in which nothing bounces. See solve_island_groups.glsl.
const bool k_bounces = false;
#include "resolution/solve_island_groups.glsl"
#include "resolution/no_hits.glsl"
