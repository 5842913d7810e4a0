// SPDX-License-Identifier: MIT
// One invocation is a pair: a bit is 1 where the constraint graph is made of it, as something about it is awake, or is touched by what
// is. All others sleep. Both are counted, by each group first.
// Reads: Counters, Manifolds, Islands, IslandFill.
// Writes: MarkCounts, one a group; Marks, k_mark_words a group; Counters.
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
layout(std430) writeonly buffer MarkCounts { uint mark_counts[]; };
layout(std430) writeonly buffer Marks { uint marks[]; };

shared uint manifold_count;
shared uint contact_count;
shared uint bits[k_mark_words];

bool is_in_graph(uint body) { return islands[body] != k_none || (island_fill[body] & k_pressed) != 0u; }

void main()
{
    uint me = gl_LocalInvocationID.x;
    bool is_first = me == 0u;
    if (me < k_mark_words) bits[me] = 0u;
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
    if (group_index() * k_count_group >= counters[k_counter_graph_pairs]) return;
    if (me < k_mark_words) marks[k_mark_words * group_index() + me] = bits[me];
    if (!is_first) return;
    uint listed_count = 0u;
    for (uint word = 0u; word < k_mark_words; ++word)
        listed_count += uint(bitCount(bits[word]));
    mark_counts[group_index()] = listed_count;
    if (manifold_count == 0u) return;
    atomicAdd(counters[k_counter_manifold_count], manifold_count);
    atomicAdd(counters[k_counter_sleeping_manifolds], manifold_count);
    atomicAdd(counters[k_counter_contact_count], contact_count);
}
