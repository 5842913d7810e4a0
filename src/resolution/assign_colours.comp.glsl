// SPDX-License-Identifier: MIT
// One group: colours the listed manifolds in rounds. In each round a manifold that outranks all others at both its
// bodies takes the smallest colour free at both (Jones and Plassmann). Before that it finds the hubs, which do not count
// as bodies here.
// Reads: Counters, Manifolds, Shapes.
// Writes: ManifoldKeys (the colour), Counters, Hubs (in any order); BodyColours and Uncoloured as it goes.
// Needs: a barrier after keep_colours.
// Overflow: a manifold with no colour left at its bodies joins the overflow set, and so does one of two hubs.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/colouring.shared.glsl"

layout(local_size_x = 1024) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Manifolds { Manifold manifolds[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) writeonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) coherent buffer BodyColours { uint body_colours[]; };
layout(std430) coherent buffer Uncoloured { uint uncoloured[]; };
layout(std430) writeonly buffer Hubs { uint hubs[]; };

shared uint left_over; // manifolds that wait for a later round

struct Edge {
    uint rank;
    uint body[2];
    bool obstructs[2]; // the body may be in the edge's colour once only
    uint hub_count;
    bool is_shared; // it takes one of the colours for hubs
};

bool is_found_hub(uint body) { return body_colours[body_word(body, k_hub_word)] != 0u; }

Edge load_edge(uint pair)
{
    Edge edge;
    edge.body[0] = manifolds[pair].body_a;
    edge.body[1] = manifolds[pair].body_b;
    bool movable[2];
    bool of_hub[2];
    for (uint end = 0u; end < 2u; ++end) {
        movable[end] = is_movable(shapes[edge.body[end]]);
        of_hub[end] = is_found_hub(edge.body[end]);
    }
    bool both_movable = movable[0] && movable[1];
    edge.hub_count = (of_hub[0] ? 1u : 0u) + (of_hub[1] ? 1u : 0u);
    edge.is_shared = edge.hub_count == 1u;
    if (edge.is_shared && !both_movable) {
        uint hub = edge.body[of_hub[0] ? 0u : 1u];
        uint low = body_colours[body_word(hub, k_used_low)];
        uint high = body_colours[body_word(hub, k_used_high)];
        edge.is_shared = colour_below_hub(low, high, parameters) == k_overflow_colour;
    }
    for (uint end = 0u; end < 2u; ++end)
        edge.obstructs[end] = movable[end] && !(of_hub[end] && edge.is_shared);
    edge.rank = edge_rank(edge.body[0], edge.body[1], both_movable);
    return edge;
}

uint free_colour(Edge edge)
{
    uint low = 0u;
    uint high = 0u;
    for (uint end = 0u; end < 2u; ++end) {
        if (edge.obstructs[end]) {
            low |= body_colours[body_word(edge.body[end], k_used_low)];
            high |= body_colours[body_word(edge.body[end], k_used_high)];
        }
    }
    if (edge.hub_count == 2u) return k_overflow_colour;
    if (edge.is_shared) return first_free_hub_colour(high);
    if (edge.hub_count == 1u) return colour_below_hub(low, high, parameters);
    return first_free_colour(low, high, parameters.usable_colours);
}

void find_hub(uint body)
{
    uint low = body_colours[body_word(body, k_used_low)];
    uint high = body_colours[body_word(body, k_used_high)];
    uint new_edges = body_colours[body_word(body, k_new_edges)];
    if (!is_hub(low, high, new_edges, parameters)) return;
    if (atomicOr(body_colours[body_word(body, k_hub_word)], k_is_hub) == 0u)
        hubs[atomicAdd(counters[k_counter_hub_count], 1u)] = body;
}

void propose(uint entry, uint rank_word)
{
    uint pair = uncoloured[entry];
    if (pair == k_none) return;
    Edge edge = load_edge(pair);
    if (free_colour(edge) == k_overflow_colour) { // colours are never given back
        manifold_keys[pair] = k_overflow_colour;
        atomicAdd(counters[k_counter_overflow_count], 1u);
        uncoloured[entry] = k_none;
        return;
    }
    for (uint end = 0u; end < 2u; ++end) {
        if (edge.obstructs[end]) atomicMax(body_colours[body_word(edge.body[end], rank_word)], edge.rank);
    }
}

void decide(uint entry, uint rank_word, uint next_rank_word)
{
    uint pair = uncoloured[entry];
    if (pair == k_none) return;
    Edge edge = load_edge(pair);
    bool wins = true;
    for (uint end = 0u; end < 2u; ++end) {
        if (edge.obstructs[end]) {
            wins = wins && body_colours[body_word(edge.body[end], rank_word)] == edge.rank;
            body_colours[body_word(edge.body[end], next_rank_word)] = 0u;
        }
    }
    if (!wins) {
        atomicAdd(left_over, 1u);
        return;
    }
    uint colour = free_colour(edge);
    uint word = colour < 32u ? k_used_low : k_used_high;
    for (uint end = 0u; end < 2u; ++end) {
        if (edge.obstructs[end]) body_colours[body_word(edge.body[end], word)] |= 1u << (colour & 31u);
        if (edge.is_shared && is_found_hub(edge.body[end]))
            atomicAdd(body_colours[body_word(edge.body[end], k_hub_word)], 1u);
    }
    manifold_keys[pair] = colour;
    if (colour < k_first_hub_colour)
        atomicMax(counters[k_counter_colour_demand], colour + 1u);
    else
        atomicAdd(counters[k_counter_hub_manifolds], 1u);
    uncoloured[entry] = k_none;
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    uint entry_count = counters[k_counter_uncoloured];
    for (uint entry = me; entry < entry_count; entry += gl_WorkGroupSize.x) {
        find_hub(manifolds[uncoloured[entry]].body_a);
        find_hub(manifolds[uncoloured[entry]].body_b);
    }
    groupMemoryBarrier();
    barrier();
    uint rank_word = k_best_rank;
    bool done = entry_count == 0u;
    while (!done) {
        if (me == 0u) left_over = 0u;
        for (uint entry = me; entry < entry_count; entry += gl_WorkGroupSize.x)
            propose(entry, rank_word);
        groupMemoryBarrier();
        barrier();
        uint next_rank_word = 2u * k_best_rank + 1u - rank_word;
        for (uint entry = me; entry < entry_count; entry += gl_WorkGroupSize.x)
            decide(entry, rank_word, next_rank_word);
        groupMemoryBarrier();
        barrier();
        done = left_over == 0u;
        rank_word = next_rank_word;
        barrier();
    }
}
