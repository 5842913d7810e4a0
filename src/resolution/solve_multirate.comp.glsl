// SPDX-License-Identifier: MIT
// Solves what no work group does in a world that may have multirate islands. See solve_persistent.glsl.
const bool k_multirate_islands = true;
#include "resolution/solve_persistent.glsl"
