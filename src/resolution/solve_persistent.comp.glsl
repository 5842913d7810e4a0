// SPDX-License-Identifier: MIT
// Solves what no work group does in a world without multirate islands. See solve_persistent.glsl.
const bool k_multirate_islands = false;
#include "resolution/solve_persistent.glsl"
