// SPDX-License-Identifier: MIT
// One pass over a colour for contacts of hubs. See solve_contacts.glsl.
const bool k_hubs = true;
#include "resolution/solve_contacts.glsl"
#include "resolution/no_hits.glsl"
