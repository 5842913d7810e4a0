// SPDX-License-Identifier: MIT
// One invocation is a pair: its manifold's place in the order of the solve, by group, then by colour, and with what is fast in a
// multirate island first. One between sleepers comes last, as those that do not touch.
// args.x: 1 where the graph is made of ListedPairs.
// Reads: ListedPairs, IslandGroups, Islands, Substeps, Manifolds; ManifoldKeys, the colour of each pair.
// Writes: Keys, which is ManifoldKeys, or apart from it where pairs are listed, one for each entry of the list; Counters, what needs
// launches and what sleeps.
// Needs: a barrier after group_islands.
// Overflow: none.
#include "state/math.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer Substeps { uint substeps[]; };
layout(std430) readonly buffer IslandGroups { uint island_groups[]; };
layout(std430) readonly buffer ListedPairs { uint listed_pairs[]; };
layout(std430) buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) buffer Keys { uint keys[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "resolution/raise_counter.glsl"

void main()
{
    uint entry = item_index();
    if (entry >= counters[k_counter_graph_pairs]) return;
    uint pair = args.x == 1u ? listed_pairs[entry] : entry;
    uint colour = manifold_keys[pair];
    if (colour == k_inactive_colour) {
        keys[entry] = inactive_key(parameters.body_count);
        return;
    }
    Manifold manifold = unpack(manifolds[pair]);
    uint body = islands[manifold.body_a] != k_none ? manifold.body_a : manifold.body_b;
    if (islands[body] == k_none) { // it wakes with the colour that it has
        keys[entry] = inactive_key(parameters.body_count);
        atomicAdd(counters[k_counter_sleeping_manifolds], 1u);
        return;
    }
    uint group = group_number(island_groups[body]);
    if (group != k_launched) {
        keys[entry] = manifold_key(group, colour);
        return;
    }
    bool in_order = (substeps[body] & k_multirate) != 0u && colour < k_first_hub_colour;
    uint its_substeps = multirate_substeps(substeps_of(manifold.demand), foot_rate_of(manifold.demand),
                                           (substeps[body] & k_multirate_tall) != 0u, parameters);
    keys[entry] =
        launched_key(colour, choose(in_order, slowness_at(counters[k_counter_launched_substeps], its_substeps), 0u));
    if (colour < k_first_hub_colour) raise_counter(k_counter_launched_colours, colours_down_to(colour));
    if (colour == k_overflow_colour) atomicAdd(counters[k_counter_launched_overflow], 1u);
}
