// SPDX-License-Identifier: MIT
// One invocation is a body slot: its island's group and sub-steps, in a multirate island its own, and its place among the
// bodies in the order of islands. What sleeps has neither, and no sub-steps. What moves as its caller says is no part of an island,
// and moves by launches.
// args.x: 1 where work groups solve islands. args.y: 1 where also those do that solve a single one. args.z: the size from
// which on an island is multirate; k_none: none is. args.w: 1 where Substeps says whether a body's island is.
// Reads: Shapes, Islands, IslandSizes, IslandStarts (scanned), IslandFill.
// Writes: Substeps, IslandFill, IslandGroups, IslandPlaces, IslandBodies, Counters. The order within an island depends on who comes
// first; nothing that is made from it does.
// Needs: a barrier after the scan of IslandStarts.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) readonly buffer IslandStarts { uint island_starts[]; };
layout(std430) buffer Substeps { uint substeps[]; };
layout(std430) buffer IslandFill { uint island_fill[]; };
layout(std430) writeonly buffer IslandGroups { uint island_groups[]; };
layout(std430) writeonly buffer IslandPlaces { uint island_places[]; };
layout(std430) writeonly buffer IslandBodies { uint island_bodies[]; };
layout(std430) buffer Counters { uint counters[]; };

// Of the islands of the group's bodies one, in which most of them often are, and where these come in it: a large island would wait
// for each of them.
shared uint main_island;
shared uint main_bodies;
shared uint main_first;

// Where in its island a body comes. Every invocation must call it, those without an island too.
uint place_in(uint island)
{
    bool is_first = gl_LocalInvocationID.x == 0u;
    if (is_first) {
        main_island = k_none;
        main_bodies = 0u;
    }
    barrier();
    if (island != k_none) atomicMin(main_island, island);
    barrier();
    bool is_of_main = island != k_none && island == main_island;
    uint place = 0u;
    if (is_of_main)
        place = atomicAdd(main_bodies, 1u);
    else if (island != k_none)
        place = atomicAdd(island_fill[island], 1u) & k_fill_count;
    barrier();
    if (is_first && main_island != k_none) main_first = atomicAdd(island_fill[main_island], main_bodies) & k_fill_count;
    barrier();
    return is_of_main ? main_first + place : place;
}

void stay_alone(uint body)
{
    island_groups[body] = k_launched;
    island_places[body] = k_none;
    bool moves = is_mover(unpack(shapes[body])) && substeps[body] != 0u;
    if (moves) atomicMax(counters[k_counter_launched_substeps], parameters.least_substeps);
}

void join_group(uint body, uint island, uint place)
{
    uint size = island_size(island_sizes[island]);
    bool multirate = args.w == 1u ? (substeps[body] & k_multirate) != 0u : size >= args.z;
    uint group = args.x == 1u && !multirate ? island_group(size, island_starts[island], args.y == 1u) : k_launched;
    island_groups[body] = group;
    island_places[body] = place;
    island_bodies[place] = body;
    uint of_island = max(number_of_substeps(substeps[island]), parameters.least_substeps);
    uint ticks = args.z != k_none ? doubled_substeps(of_island, parameters) : of_island;
    if (multirate) {
        if (body == island) atomicAdd(counters[k_counter_multirate_islands], 1u);
        bool tall = (island_fill[island] & k_tall) != 0u;
        if (body == island && !tall) atomicAdd(counters[k_counter_low_islands], 1u);
        // The island's own body has the most: others read it.
        uint own = multirate_substeps(number_of_substeps(substeps[body]), foot_rate_at(island_sizes[body]), tall, parameters);
        own = body == island ? ticks : min(own, ticks); // a rate is told a step later
        substeps[body] = own | k_multirate | (tall ? k_multirate_tall : 0u);
    } else {
        substeps[body] = of_island;
    }
    if (body == island && is_single(size) && !multirate) atomicAdd(counters[k_counter_singles], 1u);
    if (group == k_launched && body == island) atomicMax(counters[k_counter_launched_substeps], ticks);
}

void main()
{
    uint body = item_index();
    bool is_body = body < counters[k_counter_graph_bodies];
    uint island = is_body ? islands[body] : k_none;
    uint place = place_in(island);
    if (island != k_none)
        join_group(body, island, island_starts[island] + place);
    else if (is_body)
        stay_alone(body);
}
