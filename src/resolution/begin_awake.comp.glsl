// SPDX-License-Identifier: MIT
// One invocation is a body slot: once it is known who sleeps, an island of its own again where it is awake and contacts can push it.
// Launched behind choose_sleepers.
// Reads: Counters, IslandGroups (see choose_sleepers).
// Writes: Substeps, Islands, IslandSizes (of a sleeper what is to be kept of a large island), IslandStarts, IslandFill (what is touched is
// left).
// Needs: a barrier after choose_sleepers.
// Overflow: none.
#include "state/math.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer IslandGroups { uint island_groups[]; };
layout(std430) writeonly buffer Substeps { uint substeps[]; };
layout(std430) buffer Islands { uint islands[]; };
layout(std430) writeonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) writeonly buffer IslandStarts { uint island_starts[]; };
layout(std430) buffer IslandFill { uint island_fill[]; };

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_graph_bodies]) return;
    island_sizes[body] = 0u;
    if (islands[body] != k_none) {
        uint word = island_groups[body];
        bool in_part = (word & k_kept_island) != 0u;
        bool awake = word != 0u && !in_part;
        substeps[body] = awake ? word : 0u;
        islands[body] = awake ? body : k_none;
        if (in_part) island_sizes[body] = word;
    }
    island_starts[body] = 0u;
    island_fill[body] &= k_touched;
}
