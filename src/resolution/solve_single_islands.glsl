// SPDX-License-Identifier: MIT
// One group is an island of a large world that has more bodies than several could share a group. There is a group for
// each number that an island may have (island.shared.glsl); those with no island of this kind end at once.
// Before this file the kernel defines k_bounces, as for contact_passes.glsl.
// Reads: IslandBodies, IslandPlaces, IslandGroups, IslandSizes, IslandStarts; for what else it reads and writes see
// solve_in_group.glsl.
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

layout(local_size_x = 256) in; // 384 are slower by a tenth here, 192 by a quarter

layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer IslandBodies { uint island_bodies[]; };
layout(std430) readonly buffer IslandPlaces { uint island_places[]; };
layout(std430) readonly buffer IslandGroups { uint island_groups[]; };
layout(std430) readonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) readonly buffer IslandStarts { uint island_starts[]; };

uint first_place; // of the island's bodies

const uint k_room = k_most_single;
const uint k_places = k_waits_freely ? k_shared_places : k_room + 1u; // as in solve_islands
uint slots;
uint slot_of(uint body) { return slot_at(island_places[body], first_place, k_room); }

uint body_at(uint place)
{
    if (place >= parameters.body_count) return k_none;
    uint body = island_bodies[place];
    bool is_here = body < parameters.body_count && island_places[body] == place; // there are old ones between
    return is_here && island_groups[body] == single_group(group_index() + 1u) ? body : k_none;
}

const uint k_own_bodies = (k_most_single + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
uint own_body(uint i)
{
    uint slot = gl_LocalInvocationID.x + i * gl_WorkGroupSize.x;
    return slot < k_most_single ? body_at(first_place + slot) : k_none;
}

const bool k_one_island = true;

#include "resolution/solve_in_group.glsl"

void main()
{
    uint body = body_at(group_index() * k_group_window);
    if (body == k_none) return;
    first_place = island_starts[islands[body]];
    slots = island_size(island_sizes[islands[body]]) + 1u;
    solve_group(group_index() + 1u);
}
