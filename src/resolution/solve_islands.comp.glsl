// SPDX-License-Identifier: MIT
// Solves the islands of a world in which nothing bounces. See solve_islands.glsl.
const bool k_bounces = false;
#include "resolution/solve_islands.glsl"
#include "resolution/no_hits.glsl"
