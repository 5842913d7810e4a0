// SPDX-License-Identifier: MIT
// One invocation is a body slot: whether it sleeps in this step. An island that a group can solve sleeps as a whole, where nothing in it
// is restless, or touches what is. In a larger one each body sleeps that is at rest, and has been calm for as long as it has to rest.
// What sleeps as a part of one, and has not been reached, sleeps on.
// What is awake has the sub-steps that it would have if all were: with others contacts would be stiffer, and what rests would stir.
// Launched in large worlds in which bodies may sleep. args.x: the size from which on an island is multirate, where args.y is 1.
// Reads: Counters, Islands, IslandSizes, IslandStarts (see measure_islands), IslandFill, Substeps, Rests.
// Writes: IslandGroups: the sub-steps that a body is to have, as in Substeps; none where it sleeps with all of its island, and where it
// sleeps as a part what is to be kept of the island.
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
layout(std430) readonly buffer IslandStarts { uint island_starts[]; };
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
    bool is_part = (island_fill[body] & k_quiet) != 0u;
    if (is_part && (island_fill[body] & k_reached) == 0u) {
        island_groups[body] = k_kept_island;
        return;
    }
    IslandAtRest at_rest = island_at_rest(island_sizes[island], island_starts[island], args.x, args.y == 1u);
    uint own_substeps = substeps[body];
    if (at_rest.multirate) own_substeps = multirate_substeps(own_substeps, foot_rate_at(island_sizes[body]), true, parameters);
    if (is_part) own_substeps = max(own_substeps, own_substeps_kept(unpack(rests[body]).calm));
    bool awake = (island_fill[island] & k_awake) != 0u;
    if (at_rest.in_parts)
        awake = (island_fill[body] & (k_restless | k_touched)) != 0u || !is_calm(unpack(rests[body]), parameters);
    if (awake)
        island_groups[body] = at_rest.multirate ? k_multirate | own_substeps : substeps[island];
    else if (is_part)
        island_groups[body] = k_kept_island; // as it is
    else
        island_groups[body] = at_rest.in_parts ? keep_island(at_rest, own_substeps, substeps[island]) : 0u;
}
