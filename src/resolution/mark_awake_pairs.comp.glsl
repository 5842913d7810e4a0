// SPDX-License-Identifier: MIT
// One invocation is a pair: a bit is 1 where the constraint graph is made of it, as something about it is awake, or is touched by what
// is. All others sleep. Both are counted, by each group first.
// Reads: Counters, Manifolds, Islands, IslandFill.
// Writes: MarkCounts, one for k_mark_group pairs; Marks, k_mark_words for these; Counters.
// Needs: a barrier after press_sleepers.
// Overflow: none; there is a mark for every pair.
#include "state/math.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 1024) in; // k_count_group

layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer IslandFill { uint island_fill[]; };
layout(std430) writeonly buffer MarkCounts { uint mark_counts[]; };
layout(std430) writeonly buffer Marks { uint marks[]; };

shared uint manifold_count;
shared uint contact_count;
shared uint bits[k_count_group / 32u];

bool is_in_graph(uint body) { return islands[body] != k_none || (island_fill[body] & k_pressed) != 0u; }

void main()
{
    uint me = gl_LocalInvocationID.x;
    bool is_first = me == 0u;
    if (me < bits.length()) bits[me] = 0u;
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
        if (listed) atomicOr(bits[me / 32u], 1u << (me % 32u));
        if (takes_part && !listed) {
            atomicAdd(manifold_count, 1u);
            atomicAdd(contact_count, manifold.point_count);
        }
    }
    barrier();
    bool has_pairs = pair - me % k_mark_group < counters[k_counter_graph_pairs]; // whether some are counted together with it
    if (has_pairs && me % 32u == 0u) marks[pair / 32u] = bits[me / 32u];
    if (has_pairs && me % k_mark_group == 0u) {
        uint listed_count = 0u;
        for (uint word = 0u; word < k_mark_words; ++word)
            listed_count += uint(bitCount(bits[me / 32u + word]));
        mark_counts[pair / k_mark_group] = listed_count;
    }
    if (!is_first || manifold_count == 0u) return;
    atomicAdd(counters[k_counter_manifold_count], manifold_count);
    atomicAdd(counters[k_counter_sleeping_manifolds], manifold_count);
    atomicAdd(counters[k_counter_contact_count], contact_count);
}
