// SPDX-License-Identifier: MIT
// One group is a group of islands of a large world (island.shared.glsl).
// Before this file the kernel defines k_bounces, as for contact_passes.glsl.
// Reads: IslandBodies, IslandPlaces, IslandGroups; for what else it reads and writes see solve_in_group.glsl.
// Needs: a barrier after prepare_contacts.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/contact.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/hit.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer IslandBodies { uint island_bodies[]; };
layout(std430) readonly buffer IslandPlaces { uint island_places[]; };
layout(std430) readonly buffer IslandGroups { uint island_groups[]; };
layout(std430) buffer Deltas { BodyDeltaCells deltas[]; };
layout(std430) buffer WarmStarts { BodyWarmStartCells warm_starts[]; };

uint first_place() { return group_index() * k_group_window; }

const uint k_room = k_group_room;
uint slot_of(uint body) { return min(island_places[body] - first_place(), k_room); } // k_none is beyond all places

const uint k_own_bodies = k_group_room / gl_WorkGroupSize.x;
uint own_body(uint i)
{
    uint place = first_place() + gl_LocalInvocationID.x + i * gl_WorkGroupSize.x;
    if (place >= parameters.body_count) return k_none;
    uint body = island_bodies[place];
    bool is_here = body < parameters.body_count && island_places[body] == place; // there are old ones between
    return is_here && island_groups[body] == group_index() + 1u ? body : k_none;
}

// Deltas and warm starts, a float at a time: an odd number of them a slot spreads slots over all banks.
const uint k_delta_floats = 7u;
const uint k_warm_start_floats = 15u;
shared uint bodies[k_room];
shared float shared_deltas[k_delta_floats * (k_room + 1u)];
shared float shared_warm_starts[k_warm_start_floats * (k_room + 1u)];

uint body_at(uint slot) { return bodies[slot]; }

vec3 load_delta3(uint at) { return vec3(shared_deltas[at], shared_deltas[at + 1u], shared_deltas[at + 2u]); }

void store_delta3(uint at, vec3 v)
{
    shared_deltas[at] = v.x;
    shared_deltas[at + 1u] = v.y;
    shared_deltas[at + 2u] = v.z;
}

BodyDelta load_delta(uint slot)
{
    uint at = k_delta_floats * slot;
    BodyDelta delta = no_delta();
    delta.position = load_delta3(at);
    delta.rotation = vec4(load_delta3(at + 3u), shared_deltas[at + 6u]);
    return delta;
}

void store_delta(uint slot, BodyDelta delta)
{
    uint at = k_delta_floats * slot;
    store_delta3(at, delta.position);
    store_delta3(at + 3u, delta.rotation.xyz);
    shared_deltas[at + 6u] = delta.rotation.w;
}

vec3 load_warm3(uint at)
{
    return vec3(shared_warm_starts[at], shared_warm_starts[at + 1u], shared_warm_starts[at + 2u]);
}

void store_warm3(uint at, vec3 v)
{
    shared_warm_starts[at] = v.x;
    shared_warm_starts[at + 1u] = v.y;
    shared_warm_starts[at + 2u] = v.z;
}

BodyWarmStart load_warm_start(uint slot)
{
    uint at = k_warm_start_floats * slot;
    vec3 shift = load_warm3(at + 12u);
    BodyWarmStart warm;
    warm.linear = load_warm3(at);
    warm.shift_x = shift.x;
    warm.angular = load_warm3(at + 3u);
    warm.shift_y = shift.y;
    warm.linear_before = load_warm3(at + 6u);
    warm.shift_z = shift.z;
    warm.angular_before = load_warm3(at + 9u);
    warm.reserved = 0.0;
    return warm;
}

void store_warm_start(uint slot, BodyWarmStart warm)
{
    uint at = k_warm_start_floats * slot;
    store_warm3(at, warm.linear);
    store_warm3(at + 3u, warm.angular);
    store_warm3(at + 6u, warm.linear_before);
    store_warm3(at + 9u, warm.angular_before);
    store_warm3(at + 12u, vec3(warm.shift_x, warm.shift_y, warm.shift_z));
}

void clear_motion(uint slot) { store_delta(slot, no_delta()); }

void begin_motion(uint body, uint slot)
{
    bodies[slot] = body;
    store_warm_start(slot, unpack(warm_starts[body]));
}

void end_motion(uint body, uint slot)
{
    deltas[body] = pack(load_delta(slot));
    warm_starts[body] = pack(load_warm_start(slot));
}

#include "resolution/solve_in_group.glsl"

void main() { solve_group(group_index() + 1u); }
