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

// Changes nothing on its way: others may have named the islands of what it passes.
uint root_of(uint body)
{
    uint parent = islands[body];
    while (parent != body) {
        body = parent;
        parent = islands[body];
    }
    return body;
}

void stand_for_island(uint island, uint kept)
{
    atomicMax(substeps[island], substeps_kept(kept));
    uint said = parts_said(kept);
    if ((island_starts[island] & said) != said) atomicOr(island_starts[island], said);
}

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_graph_bodies] || islands[body] == k_none) return;
    bool is_part = args.x == 1u && (island_fill[body] & k_quiet) != 0u;
    if (is_part && (island_fill[body] & k_reached) == 0u) return;
    uint island = root_of(body);
    islands[body] = island;
    atomicMax(substeps[island], substeps[body]);
    bool keeps_awake = (island_fill[body] & (k_restless | k_touched)) != 0u;
    if (keeps_awake && (island_fill[island] & k_awake) == 0u) atomicOr(island_fill[island], k_awake);
    bool is_tall = (island_fill[body] & k_tall) != 0u;
    if (is_tall && (island_fill[island] & k_tall) == 0u) atomicOr(island_fill[island], k_tall);
    bool is_hub = body_colours[body_word(body, k_hub_word)] != 0u;
    atomicAdd(island_sizes[island], is_hub ? 1u + k_most_single : 1u);
    if (is_part)
        stand_for_island(island, unpack(rests[body]).calm);
    else if (args.x == 0u)
        atomicAdd(island_starts[island], 1u);
}
