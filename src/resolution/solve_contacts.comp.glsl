// SPDX-License-Identifier: MIT
// One pass over a colour of the constraint graph, or over the overflow set. See solve_contacts.glsl.
const bool k_hubs = false;
#include "resolution/solve_contacts.glsl"
#include "resolution/stored_hits.glsl"
