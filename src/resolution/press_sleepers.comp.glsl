// SPDX-License-Identifier: MIT
// One invocation is a pair: a sleeper that something awake touches is pressed.
// Launched behind begin_awake.
// Reads: Counters, Manifolds, Islands, Substeps.
// Writes: IslandFill.
// Needs: a barrier after begin_awake.
// Overflow: none.
#include "state/math.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer Substeps { uint substeps[]; };
layout(std430) buffer IslandFill { uint island_fill[]; };

void main()
{
    uint pair = item_index();
    if (pair >= counters[k_counter_graph_pairs]) return;
    Manifold manifold = unpack(manifolds[pair]);
    bool awake_a = islands[manifold.body_a] != k_none;
    bool awake_b = islands[manifold.body_b] != k_none;
    if (awake_a == awake_b || !is_active(manifold)) return;
    uint other = awake_a ? manifold.body_b : manifold.body_a;
    bool is_news = substeps[other] == 0u && (island_fill[other] & k_pressed) == 0u;
    if (is_news) atomicOr(island_fill[other], k_pressed); // others may do the same
}
