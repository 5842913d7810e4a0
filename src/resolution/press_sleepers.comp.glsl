// SPDX-License-Identifier: MIT
// One invocation is a pair: a sleeper that something awake touches is pressed.
// Launched behind begin_awake.
// Reads: Counters, Pairs, Islands, Substeps; Manifolds, where one of two bodies is awake.
// Writes: IslandFill.
// Needs: a barrier after begin_awake.
// Overflow: none.
#include "state/math.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer Substeps { uint substeps[]; };
layout(std430) buffer IslandFill { uint island_fill[]; };

void main()
{
    uint pair_index = item_index();
    if (pair_index >= counters[k_counter_graph_pairs]) return;
    Pair pair = pairs[pair_index];
    bool awake_a = islands[pair.body_a] != k_none;
    bool awake_b = islands[pair.body_b] != k_none;
    if (awake_a == awake_b || !is_active(unpack(manifolds[pair_index]))) return;
    uint other = awake_a ? pair.body_b : pair.body_a;
    bool is_news = substeps[other] == 0u && (island_fill[other] & k_pressed) == 0u;
    if (is_news) atomicOr(island_fill[other], k_pressed); // others may do the same
}
