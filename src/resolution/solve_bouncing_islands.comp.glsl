// SPDX-License-Identifier: MIT
// Solves the islands of a world in which something may bounce. See solve_islands.glsl. The two are kernels of their own
// as the code of a hit slows the passes by a tenth even where it never runs.
const bool k_bounces = true;
#include "resolution/solve_islands.glsl"
#include "resolution/stored_hits.glsl"
