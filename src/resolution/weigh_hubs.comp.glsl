// SPDX-License-Identifier: MIT
// Where the constraint graph is the last step's: the loads on hubs anew, in parts. An invocation takes a pair, and the next
// one beyond all groups. Where the loads would give a contact other colours to choose from, so that it might get another
// one, the graph is due.
// args.x: 1 to count how many groups can run at a time instead.
// Reads: Manifolds, PointImpulses, Shapes, Hubs.
// Writes: BodyColours (loads of hubs), Counters; Uncoloured, as loads_on_pairs, and Arrivals as it goes.
// Needs: a barrier after collide_pairs; no more groups than can run at a time; arrivals[0] is 0.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/hub_load.shared.glsl"
#include "resolution/hub.shared.glsl"

layout(local_size_x = 1024) in;

layout(std430) coherent buffer Counters { uint counters[]; };
layout(std430) readonly buffer Manifolds { Manifold manifolds[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) readonly buffer Hubs { uint hubs[]; };
layout(std430) coherent buffer BodyColours { uint body_colours[]; };
layout(std430) buffer Uncoloured { uint loads_on_pairs[]; }; // nothing is listed where no graph is made

#include "resolution/hub_load.glsl"

uint group_count; // that have pairs
uint meeting_groups() { return group_count; }

#include "primitives/grid_barrier.glsl"

void begin_hub(uint hub)
{
    body_colours[body_word(hub, k_largest_load)] = largest_load_word(0u);
    body_colours[body_word(hub, k_whole_load)] = 0u;
    body_colours[body_word(hub, k_unshared_load)] = 0u;
}

void find_largest_load(uint pair)
{
    Manifold manifold = manifolds[pair];
    uint hub = is_active(manifold) ? hub_of(manifold) : k_none;
    if (hub == k_none) return;
    uint load = floatBitsToUint(load_on(pair, manifold.point_count));
    loads_on_pairs[pair] = load;
    atomicMax(body_colours[body_word(hub, k_largest_load)], largest_load_word(load));
}

void add_load(uint pair)
{
    Manifold manifold = manifolds[pair];
    uint hub = is_active(manifold) ? hub_of(manifold) : k_none;
    if (hub == k_none) return;
    uint part = part_of_load(manifold, uintBitsToFloat(loads_on_pairs[pair]), hub);
    atomicAdd(body_colours[body_word(hub, k_whole_load)], part);
}

void compare_colours(uint pair)
{
    Manifold manifold = manifolds[pair];
    uint hub = is_active(manifold) ? hub_of(manifold) : k_none;
    if (hub == k_none) return;
    uint part = part_of_load(manifold, uintBitsToFloat(loads_on_pairs[pair]), hub);
    bool both_movable = is_movable(shapes[manifold.body_a]) && is_movable(shapes[manifold.body_b]);
    uint usable = colours_of_hubs_edge(manifold, part, hub, both_movable);
    if (!keeps_colour(manifold.colour, usable, both_movable, parameters)) counters[k_counter_graph_due] = 1u;
    if (!is_hub_colour(manifold.colour)) atomicAdd(body_colours[body_word(hub, k_unshared_load)], part);
}

void main()
{
    if (args.x == 1u) {
        count_resident_groups();
        return;
    }
    uint hub_count = counters[k_counter_hub_count];
    uint pair_count = counters[k_counter_pair_count];
    group_count = min((pair_count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x, gl_NumWorkGroups.x);
    if (hub_count == 0u || gl_WorkGroupID.x >= group_count) return;
    uint first = gl_WorkGroupID.x * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    uint stride = group_count * gl_WorkGroupSize.x;
    for (uint i = first; i < hub_count; i += stride)
        begin_hub(hubs[i]);
    wait_for_all_groups();
    for (uint pair = first; pair < pair_count; pair += stride)
        find_largest_load(pair);
    wait_for_all_groups();
    for (uint pair = first; pair < pair_count; pair += stride)
        add_load(pair);
    wait_for_all_groups();
    for (uint pair = first; pair < pair_count; pair += stride)
        compare_colours(pair);
}
