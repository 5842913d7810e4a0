// SPDX-License-Identifier: MIT
// One group is a group of islands of a large world (island.shared.glsl).
// Before this file the kernel defines k_bounces, as for contact_passes.glsl.
// Reads: IslandBodies, IslandPlaces, IslandGroups; for what else it reads and writes see solve_in_group.glsl.
// Needs: a barrier after prepare_contacts.
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

layout(local_size_x = 64) in;

layout(std430) readonly buffer IslandBodies { uint island_bodies[]; };
layout(std430) readonly buffer IslandPlaces { uint island_places[]; };
layout(std430) readonly buffer IslandGroups { uint island_groups[]; };

uint first_place() { return group_index() * k_group_window; }

const uint k_room = k_group_room;
const uint slots = k_room + 1u;
const uint k_places = 2u * slots;
uint slot_of(uint body) { return slot_at(island_places[body], first_place(), k_room); }

const uint k_own_bodies = k_group_room / gl_WorkGroupSize.x;
uint own_body(uint i)
{
    uint place = first_place() + gl_LocalInvocationID.x + i * gl_WorkGroupSize.x;
    if (place >= parameters.body_count) return k_none;
    uint body = island_bodies[place];
    bool is_here = body < parameters.body_count && island_places[body] == place; // there are old ones between
    return is_here && island_groups[body] == group_index() + 1u ? body : k_none;
}

const bool k_one_island = false;

#include "resolution/solve_in_group.glsl"

void main() { solve_group(group_index() + 1u); }
