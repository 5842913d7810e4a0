// SPDX-License-Identifier: MIT
// Solves islands of a large world one by one, where nothing bounces. See solve_single_islands.glsl.
const bool k_bounces = false;
#include "resolution/solve_single_islands.glsl"
#include "resolution/no_hits.glsl"
