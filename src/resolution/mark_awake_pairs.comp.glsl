// SPDX-License-Identifier: MIT
// One invocation is a pair: 1 where the constraint graph is made of it, as something about it is awake, or is touched by what is. All
// others sleep, and are counted, each group's first.
// Reads: Counters, Manifolds, Islands, IslandFill.
// Writes: Marks; Counters.
// Needs: a barrier after press_sleepers.
// Overflow: none; there is a mark for every pair.
#include "state/math.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 256) in; // k_count_group

layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer IslandFill { uint island_fill[]; };
layout(std430) writeonly buffer Marks { uint marks[]; };

shared uint manifold_count;
shared uint contact_count;

bool is_in_graph(uint body) { return islands[body] != k_none || (island_fill[body] & k_pressed) != 0u; }

void main()
{
    bool is_first = gl_LocalInvocationID.x == 0u;
    if (is_first) {
        manifold_count = 0u;
        contact_count = 0u;
    }
    barrier();
    uint pair = item_index();
    if (pair < counters[k_counter_graph_pairs]) {
        Manifold manifold = unpack(manifolds[pair]);
        bool takes_part = is_active(manifold);
        bool listed = takes_part && (is_in_graph(manifold.body_a) || is_in_graph(manifold.body_b));
        marks[pair] = listed ? 1u : 0u;
        if (takes_part && !listed) {
            atomicAdd(manifold_count, 1u);
            atomicAdd(contact_count, manifold.point_count);
        }
    }
    barrier();
    if (!is_first || manifold_count == 0u) return;
    atomicAdd(counters[k_counter_manifold_count], manifold_count);
    atomicAdd(counters[k_counter_sleeping_manifolds], manifold_count);
    atomicAdd(counters[k_counter_contact_count], contact_count);
}
