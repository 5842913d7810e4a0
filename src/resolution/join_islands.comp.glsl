// SPDX-License-Identifier: MIT
// One invocation is a pair: joins the islands of two bodies that touch, by hanging one root below the other
// (Jaiganesh and Burtscher, "A High-Performance Connected Components Implementation for GPUs", 2018). A body asks for the
// sub-steps of the manifold that asks for most, and notes the highest foot rate. Where it is asked who sleeps, contacts between the
// quiet are left alone.
// args.x: k_join_*. The awake ones are those of listed pairs. args.y: k_pairs_*, whose turn it is.
// Reads: Counters, Manifolds; Pairs, where it is asked who sleeps; ListedPairs.
// Writes: Islands; Substeps; IslandSizes (foot rates); IslandFill, what is touched, and which parts are reached.
// Which body hangs below which depends on who comes first; the roots do not.
// Needs: a barrier after begin_graph.
// Overflow: none.
#include "state/math.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer ListedPairs { uint listed_pairs[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) coherent buffer Islands { uint islands[]; };
layout(std430) buffer Substeps { uint substeps[]; };
layout(std430) buffer IslandSizes { uint island_sizes[]; };
layout(std430) buffer IslandFill { uint island_fill[]; };

// The root of the tree of a body with this parent. On the way each body is led to its grandparent: an invocation that still sees
// the parent finds the same root, later.
uint root_of(uint body, uint parent)
{
    while (parent != body) {
        uint grandparent = islands[parent];
        if (grandparent != parent) islands[body] = grandparent;
        body = parent;
        parent = grandparent;
    }
    return body;
}

void join(uint body_a, uint parent_a, uint body_b, uint parent_b)
{
    uint root_a = root_of(body_a, parent_a);
    uint root_b = root_of(body_b, parent_b);
    while (root_a != root_b) {
        bool a_stays = order_of_root(root_a) < order_of_root(root_b);
        uint root = a_stays ? root_a : root_b;
        uint other = a_stays ? root_b : root_a;
        uint found = atomicCompSwap(islands[other], other, root);
        if (found == other) return;
        // Somebody else has hung it elsewhere meanwhile.
        root_a = root_of(found, islands[found]);
        root_b = root_of(root, islands[root]);
    }
}

// Others may note the same.
void note(uint body, uint what)
{
    if ((island_fill[body] & what) == 0u) atomicOr(island_fill[body], what);
}

// Most ask for the fewest, which each body has from begin_graph on, and have no foot rate.
void ask_for_substeps(uint body, uint demand)
{
    if (substeps_of(demand) > parameters.fewest_substeps) atomicMax(substeps[body], substeps_of(demand));
    if (foot_rate_of(demand) > 0u && foot_rate_at(island_sizes[body]) < foot_rate_of(demand))
        atomicMax(island_sizes[body], foot_rate_of(demand) << k_foot_rate_shift);
    if (is_in_tall_column(demand)) note(body, k_tall);
}

bool is_quiet(uint body) { return (island_fill[body] & k_quiet) != 0u; }

void main()
{
    uint entry = item_index();
    if (entry >= counters[k_counter_graph_pairs] || !is_in_part(group_index(), args.y)) return;
    uint pair = args.x == k_join_awake ? listed_pairs[entry] : entry;
    if (args.x == k_join_to_sleep && is_quiet(pairs[pair].body_a) && is_quiet(pairs[pair].body_b)) return;
    Manifold manifold = unpack(manifolds[pair]);
    if (!is_active(manifold)) return;
    uint parent_a = islands[manifold.body_a];
    uint parent_b = islands[manifold.body_b];
    bool pushes_a = parent_a != k_none;
    bool pushes_b = parent_b != k_none;
    if (args.x == k_join_to_sleep) {
        if ((island_fill[manifold.body_a] & k_restless) != 0u) note(manifold.body_b, k_touched);
        if ((island_fill[manifold.body_b] & k_restless) != 0u) note(manifold.body_a, k_touched);
        if (is_quiet(manifold.body_a)) note(manifold.body_a, k_reached);
        if (is_quiet(manifold.body_b)) note(manifold.body_b, k_reached);
    }
    if (args.x != k_join_awake) {
        if (pushes_a) ask_for_substeps(manifold.body_a, manifold.demand);
        if (pushes_b) ask_for_substeps(manifold.body_b, manifold.demand);
    }
    if (pushes_a && pushes_b) join(manifold.body_a, parent_a, manifold.body_b, parent_b);
}
