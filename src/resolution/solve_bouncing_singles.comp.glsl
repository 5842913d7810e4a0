// SPDX-License-Identifier: MIT
// Solves islands of a large world one by one, where something may bounce. See solve_single_islands.glsl.
const bool k_bounces = true;
#include "resolution/solve_single_islands.glsl"
#include "resolution/stored_hits.glsl"
