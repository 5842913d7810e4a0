// SPDX-License-Identifier: MIT
// One invocation is a body slot: whether it sleeps in this step. An island that a group can solve sleeps as a whole, where nothing in it
// is restless, or touches what is. In a larger one each body sleeps that is at rest, and has been calm for as long as it has to rest.
// What is awake has the sub-steps that it would have if all were: with others contacts would be stiffer, and what rests would stir.
// Launched in large worlds in which bodies may sleep. args.x: the size from which on an island is multirate; k_none: none is.
// Reads: Counters, Islands, IslandSizes, IslandFill, Substeps, Rests.
// Writes: IslandGroups: the sub-steps that a body is to have, as in Substeps; none where it sleeps.
// Needs: a barrier after measure_islands.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) readonly buffer IslandFill { uint island_fill[]; };
layout(std430) readonly buffer Rests { BodyRestCells rests[]; };
layout(std430) readonly buffer Substeps { uint substeps[]; };
layout(std430) writeonly buffer IslandGroups { uint island_groups[]; };

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_graph_bodies]) return;
    uint island = islands[body];
    if (island == k_none) return;
    bool asleep = (island_fill[island] & k_awake) == 0u;
    if (sleeps_in_parts(island_sizes[island]))
        asleep = (island_fill[body] & (k_restless | k_touched)) == 0u && is_calm(unpack(rests[body]), parameters);
    bool multirate = is_multirate_island(island_sizes[island], args.x);
    island_groups[body] = asleep ? 0u : multirate ? k_multirate | substeps[body] : substeps[island];
}
