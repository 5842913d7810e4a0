// SPDX-License-Identifier: MIT
// One invocation is a body slot: names its island, and adds itself to it. A hub counts as more than a group can solve,
// as it needs launches of its own.
// args.x: 1 where it is asked who sleeps, and what sleeps as a part of a large island stands for that. It adds nothing where nothing has
// reached it.
// Reads: Counters, BodyColours; of such parts Rests.
// Writes: Islands; of the island IslandSizes, IslandStarts (its bodies, or where it is asked who sleeps what its parts say) and Substeps;
// in IslandFill, that it is awake, or tall.
// Needs: barriers after join_islands and assign_colours; where it is asked who sleeps, for which hubs do not count, after the first alone.
// Overflow: none.
#include "state/math.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer BodyColours { uint body_colours[]; };
layout(std430) readonly buffer Rests { BodyRestCells rests[]; };
layout(std430) coherent buffer Islands { uint islands[]; };
layout(std430) buffer Substeps { uint substeps[]; };
layout(std430) buffer IslandSizes { uint island_sizes[]; };
layout(std430) buffer IslandStarts { uint island_starts[]; };
layout(std430) buffer IslandFill { uint island_fill[]; };

#include "resolution/root_of.glsl"

void stand_for_island(uint island, uint kept)
{
    atomicMax(substeps[island], substeps_kept(kept));
    uint said = parts_said(kept);
    if ((island_starts[island] & said) != said) atomicOr(island_starts[island], said);
}

// What a body, or several, add to an island.
void add_to(uint island, uint size, uint bodies, uint its_substeps)
{
    atomicAdd(island_sizes[island], size);
    if (bodies > 0u) atomicAdd(island_starts[island], bodies);
    atomicMax(substeps[island], its_substeps);
}

bool is_part(uint body) { return args.x == 1u && (island_fill[body] & k_quiet) != 0u; }

// The island of a body that adds something to one, else k_none.
uint name_island(uint body)
{
    if (body >= counters[k_counter_graph_bodies] || islands[body] == k_none) return k_none;
    if (is_part(body) && (island_fill[body] & k_reached) == 0u) return k_none;
    uint island = root_of(body);
    islands[body] = island;
    bool keeps_awake = (island_fill[body] & (k_restless | k_touched)) != 0u;
    if (keeps_awake && (island_fill[island] & k_awake) == 0u) atomicOr(island_fill[island], k_awake);
    bool is_tall = (island_fill[body] & k_tall) != 0u;
    if (is_tall && (island_fill[island] & k_tall) == 0u) atomicOr(island_fill[island], k_tall);
    if (is_part(body)) stand_for_island(island, unpack(rests[body]).calm);
    return island;
}

// Of the islands of the group's bodies one, in which most of them often are, and what these add to it: a large island would wait for
// each of them.
shared uint main_island;
shared uint main_size;
shared uint main_bodies;
shared uint main_substeps;

void main()
{
    bool is_first = gl_LocalInvocationID.x == 0u;
    if (is_first) {
        main_island = k_none;
        main_size = 0u;
        main_bodies = 0u;
        main_substeps = 0u;
    }
    barrier();
    uint body = item_index();
    uint island = name_island(body);
    if (island != k_none) atomicMin(main_island, island);
    barrier();
    if (island != k_none) {
        bool is_hub = body_colours[body_word(body, k_hub_word)] != 0u;
        uint size = is_hub ? 1u + k_most_single : 1u;
        uint bodies = args.x == 0u ? 1u : 0u;
        if (island == main_island) {
            atomicAdd(main_size, size);
            atomicAdd(main_bodies, bodies);
            atomicMax(main_substeps, substeps[body]);
        } else {
            add_to(island, size, bodies, substeps[body]);
        }
    }
    barrier();
    if (is_first && main_island != k_none) add_to(main_island, main_size, main_bodies, main_substeps);
}
