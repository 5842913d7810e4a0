// SPDX-License-Identifier: MIT
// One group is an island of a small world. There is a group for each body slot; those that lead no island end at once.
// Before this file the kernel defines k_bounces, as for contact_passes.glsl.
// Reads and writes: see solve_in_group.glsl.
// Needs: a barrier after prepare_contacts. At most k_island_bodies body slots.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_counts.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/contact.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/hit.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 384) in; // most islands have no more manifolds; with more, registers get short

layout(std430) readonly buffer Islands { uint islands[]; };

const uint k_room = k_island_bodies;
const uint k_places = k_waits_freely ? k_shared_places : k_room + 1u; // all drivers have 32 KB, and these take 28
uint slots;
uint slot_of(uint body) { return islands[body] == k_none ? 0u : body + 1u; }

const uint k_own_bodies = (k_island_bodies + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
uint own_body(uint i)
{
    uint body = gl_LocalInvocationID.x + i * gl_WorkGroupSize.x;
    return body < parameters.body_count && islands[body] == group_index() ? body : k_none;
}

const bool k_one_island = true;

#include "resolution/solve_in_group.glsl"

void main()
{
    uint island = group_index();
    slots = parameters.body_count + 1u;
    if (islands[island] == island) solve_group(island);
}
