// SPDX-License-Identifier: MIT
// What a work group does that solves islands: all their sub-steps, with velocities in shared memory. Contacts wait for each other
// one by one (solve_in_turn.glsl), or at a barrier after each colour where the device has no such waits.
// Before this file the kernel gives its number of invocations, declares Islands, and defines
//   const bool k_bounces, as for contact_passes.glsl
//   const uint k_room, the bodies that there is room for
//   const uint k_places, in shared memory, each for the velocity or the movement of a body
//   uint slots, that are in use: one for each body, and the first one for all that nothing moves
//   uint slot_of(uint body)
//   const uint k_own_bodies, the most that an invocation has, and uint own_body(uint i), k_none for no body
//   const bool k_one_island, whether the group has one island and not several
// Reads: Islands, ManifoldKeys, Counters, Constraints, Inertias, Properties, Loads.
// Writes: Velocities, Deltas, WarmStarts, Constraints (impulses); Poses (flags) and Counters where a body is frozen.

layout(std430) readonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };

// The velocities by slot; then the movements, if there are places for both. Else these are in their buffer.
shared vec4 vec4s[k_places];       // linear part and inverse mass, or rotation
shared float vec3s[3u * k_places]; // angular part, or position
shared uint most_substeps;
shared uint search_bounds[2];
// Where the group's manifolds of each colour begin; the overflow set last.
shared uint colour_offsets[k_colour_offsets];

vec3 vec3_at(uint place) { return vec3(vec3s[3u * place], vec3s[3u * place + 1u], vec3s[3u * place + 2u]); }

void put_in_place(uint place, vec4 first, vec3 rest)
{
    vec4s[place] = first;
    vec3s[3u * place] = rest.x;
    vec3s[3u * place + 1u] = rest.y;
    vec3s[3u * place + 2u] = rest.z;
}

BodyVelocity load_velocity(uint slot)
{
    vec4 first = vec4s[slot];
    BodyVelocity velocity;
    velocity.linear = first.xyz;
    velocity.inverse_mass = first.w;
    velocity.angular = vec3_at(slot);
    velocity.stamp = 0u;
    return velocity;
}

void store_velocity(uint slot, BodyVelocity velocity)
{
    put_in_place(slot, vec4(velocity.linear, velocity.inverse_mass), velocity.angular);
}

const bool k_multirate_islands = false; // they are too large

#include "resolution/stored_deltas.glsl"

bool deltas_have_places() { return 2u * slots <= k_places; }

BodyDelta load_delta(uint body, uint slot)
{
    BodyDelta delta;
    if (deltas_have_places()) {
        delta.position = vec3_at(slots + slot);
        delta.reserved = 0.0;
        delta.rotation = vec4s[slots + slot];
    } else {
        delta = load_stored_delta(body);
    }
    return delta;
}

void put_delta(uint slot, BodyDelta delta) { put_in_place(slots + slot, delta.rotation, delta.position); }

void store_delta(uint body, uint slot, BodyDelta delta)
{
    if (deltas_have_places())
        put_delta(slot, delta);
    else
        store_stored_delta(body, delta);
}

const bool k_hubs = false; // their islands are solved with a launch for each colour
void put_change(uint index, HubChange change) {}

bool is_own(BodyInertia inertia) { return true; }
BodyVelocity load_settled_velocity(uint slot, uint its_traits) { return load_velocity(slot); }

void look_early() {} // velocities are in shared memory

#include "resolution/contact_passes.glsl"
#include "resolution/body_passes.glsl"
const bool k_notes_unlike = false;
#include "resolution/solve_substeps.glsl"

// Where the group's manifolds begin and end. `group`: the number in their keys. Half of the invocations look for each:
// they ask at places that are evenly apart, and then between two of these. A search by halves would have four or five
// times as many loads that wait for each other.
void find_manifolds(uint group)
{
    uint probes = gl_WorkGroupSize.x / 2u;
    uint side = gl_LocalInvocationID.x / probes; // 0 the beginning, 1 the end
    uint probe = gl_LocalInvocationID.x % probes;
    uint key = manifold_key(group + side, 0u);
    uint manifold_count = counters[k_counter_manifold_count];
    uint lower = 0u; // keys before it are lower
    for (uint span = manifold_count; span > 0u;) { // the key beyond `span` more is not
        uint stride = (span + probes - 1u) / probes;
        if (probe == 0u) search_bounds[side] = lower;
        barrier();
        uint begin = lower + probe * stride;
        uint end = min(min(begin + stride, lower + span), manifold_count);
        if (begin < end && manifold_keys[end - 1u] < key) atomicMax(search_bounds[side], end);
        barrier();
        lower = search_bounds[side];
        span = stride - 1u;
        barrier();
    }
    if (probe == 0u) search_bounds[side] = lower;
    barrier();
}

void find_colours(uint group)
{
    find_manifolds(group);
    uint first = search_bounds[0];
    uint end = search_bounds[1];
    uint me = gl_LocalInvocationID.x;
    for (uint colour = me; colour < k_colour_offsets; colour += gl_WorkGroupSize.x)
        colour_offsets[colour] = colour == 0u ? first : end;
    barrier();
    // A manifold whose key is another one than that before it begins its colour, and those in between.
    for (uint index = first + me; index < end; index += gl_WorkGroupSize.x) {
        uint colour = colour_of_key(manifold_keys[index]);
        uint before = index > first ? colour_of_key(manifold_keys[index - 1u]) : 0u;
        for (uint each = before + 1u; each <= min(colour, k_max_colours + 1u); ++each)
            colour_offsets[each] = index;
    }
}

uint workers() { return gl_WorkGroupSize.x; }

void wait_for_workers()
{
    groupMemoryBarrier();
    barrier();
}

#include "resolution/solve_in_turn.glsl"

// ---- islands ----

uint own_bodies; // a bit for each

void integrate_own_bodies(uint tick)
{
    for (uint i = 0u; own_bodies >> i != 0u; ++i) {
        if (((own_bodies >> i) & 1u) == 1u) integrate_body(own_body(i), tick);
    }
}

void note_unlike() {}

void solve_group(uint group)
{
    uint me = gl_LocalInvocationID.x;
    if (me == 0u) {
        most_substeps = 0u;
        has_given_up = 0u;
        store_velocity(0u, frozen_velocity());
        if (deltas_have_places()) put_delta(0u, no_delta());
    }
    barrier();
    own_bodies = 0u;
    for (uint i = 0u; i < k_own_bodies; ++i) {
        uint body = own_body(i);
        if (body == k_none) continue;
        own_bodies |= 1u << i;
        uint slot = slot_of(body);
        begin_turns(slot);
        store_velocity(slot, unpack(velocities[body]));
        if (deltas_have_places()) put_delta(slot, no_delta());
        atomicMax(most_substeps, unpack(inertias[body]).substeps);
    }
    barrier();
    if (most_substeps == 0u) return; // nobody is here, or awake
    find_colours(group);
    barrier();
    solve_substeps(most_substeps);
    if (have_given_up()) return; // the velocities are as they were
    for (uint i = 0u; own_bodies >> i != 0u; ++i) {
        if (((own_bodies >> i) & 1u) == 0u) continue;
        uint body = own_body(i);
        uint slot = slot_of(body);
        velocities[body] = pack(load_velocity(slot));
        if (deltas_have_places()) store_stored_delta(body, load_delta(body, slot));
    }
}
