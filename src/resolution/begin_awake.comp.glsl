// SPDX-License-Identifier: MIT
// One invocation is a body slot: once it is known who sleeps, an island of its own again where it is awake and contacts can push it,
// and no sums of what presses on it yet.
// Launched behind choose_sleepers.
// Reads: Counters, IslandGroups (see choose_sleepers).
// Writes: Substeps, Islands, IslandSizes, IslandStarts, IslandFill (what is touched is left), Balances.
// Needs: a barrier after choose_sleepers.
// Overflow: none.
#include "state/math.shared.glsl"
#include "resolution/island.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/balance.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer IslandGroups { uint island_groups[]; };
layout(std430) writeonly buffer Substeps { uint substeps[]; };
layout(std430) buffer Islands { uint islands[]; };
layout(std430) writeonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) writeonly buffer IslandStarts { uint island_starts[]; };
layout(std430) buffer IslandFill { uint island_fill[]; };
layout(std430) writeonly buffer Balances { uint balances[]; };

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_graph_bodies]) return;
    if (islands[body] != k_none) {
        substeps[body] = island_groups[body];
        islands[body] = island_groups[body] != 0u ? body : k_none;
    }
    island_sizes[body] = 0u;
    island_starts[body] = 0u;
    island_fill[body] &= k_touched;
    for (uint word = 0u; word < k_balance_words; ++word)
        balances[k_balance_words * body + word] = 0u;
}
