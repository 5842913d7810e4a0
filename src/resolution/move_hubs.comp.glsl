// SPDX-License-Identifier: MIT
// One group is a hub: adds up what the constraints of one colour have done to it.
// args.x: the colour; args.z: the tick.
// Reads: Hubs, HubChanges, ColourOffsets, Inertias.
// Writes: Velocities.
// Needs: a barrier after solve_hub_contacts of the colour.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/hub.shared.glsl"

layout(local_size_x = 256) in; // k_hub_group

layout(std430) readonly buffer Hubs { uint hubs[]; };
layout(std430) readonly buffer HubChanges { HubChange hub_changes[]; };
layout(std430) readonly buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) readonly buffer Inertias { BodyInertiaCells inertias[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };

BodyVelocity load_velocity(uint body) { return unpack(velocities[body]); }
void store_velocity(uint body, BodyVelocity velocity) { velocities[body] = pack(velocity); }
HubChange load_change(uint i) { return hub_changes[i]; }

#include "resolution/move_hubs.glsl"

void main() { move_hub_by_colour(hubs[group_index()], args.x, args.z); }
