// SPDX-License-Identifier: MIT
// Colours the listed manifolds in rounds. In each round a manifold that outranks all others at both its bodies takes the
// first colour free at both (Jones and Plassmann). Before that it finds the hubs, which do not count as bodies for most
// of their manifolds, and the loads on them. As many groups as have manifolds wait for each other after each part of a
// round; it is one where little is new. What has kept a doubtful colour is looked at first, and joins the others where it gives it
// up. Where all is new, it is coloured again.
// args.x: 1 to count how many groups can run at a time instead. args.y: 1 where bodies may sleep that are in the graph.
// Reads: Manifolds, Shapes; Substeps where bodies may sleep.
// Writes: ManifoldKeys (the colour, where the load was), Counters, Hubs (in any order); BodyColours, Uncoloured and Arrivals
// as it goes.
// Needs: a barrier after keep_colours; no more groups than can run at a time; arrivals[0] is 0.
// Overflow: a manifold with no colour left at its bodies joins the overflow set, and so does one of two hubs.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/hub_load.shared.glsl"

layout(local_size_x = 1024) in;

layout(std430) coherent buffer Counters { uint counters[]; };
layout(std430) readonly buffer Manifolds { Manifold manifolds[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) readonly buffer Substeps { uint substeps[]; };
layout(std430) buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) coherent buffer BodyColours { uint body_colours[]; };
layout(std430) coherent buffer Uncoloured { uint uncoloured[]; };
layout(std430) coherent buffer Hubs { uint hubs[]; };

#include "resolution/hub_load.glsl"
#include "resolution/raise_counter.glsl"

shared uint left_over; // manifolds of this group that wait for a later round

const uint k_all_left_over = 2u; // the word of Arrivals with those of all groups and rounds

uint group_count; // that have manifolds
uint meeting_groups() { return group_count; }

// As many groups as there are entries for, the first ones of the launch.
void meet_for(uint entry_count)
{
    group_count = min((entry_count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x, gl_NumWorkGroups.x);
}

#include "primitives/grid_barrier.glsl"

void wait_for_workers()
{
    if (group_count > 1u) {
        wait_for_all_groups();
    } else {
        groupMemoryBarrier();
        barrier();
    }
}

struct Edge {
    uint pair; // k_none: it has a colour
    Manifold manifold;
    bool movable[2]; // A, B
    uint rank;
    uint hub;          // k_none where there is none, or two
    uint part;         // of the hub's load
    uint colour;       // that it would take now
    bool is_shared;    // that is one of the colours for hubs
    bool obstructs[2]; // A, B may be in the edge's colour once only
};

// Of an entry of the list: kept from round to round, as most invocations have one only.
Edge edge;
uint entry_in_hand = k_none;
bool again = false; // what gets a colour has had one

uint body_at(uint end) { return end == 0u ? edge.manifold.body_a : edge.manifold.body_b; }

void find_colour()
{
    uint low = 0u;
    uint high = 0u;
    uint high_of_other = 0u; // than the hub
    for (uint end = 0u; end < 2u; ++end) {
        if (!edge.movable[end]) continue;
        uint its_high = body_colours[body_word(body_at(end), k_used_high)];
        low |= body_colours[body_word(body_at(end), k_used_low)];
        high |= its_high;
        if (body_at(end) != edge.hub) high_of_other = its_high;
    }
    bool both_movable = edge.movable[0] && edge.movable[1];
    uint usable = is_found_hub(body_at(0u)) && is_found_hub(body_at(1u)) ? 0u : parameters.usable_colours;
    if (edge.hub != k_none) usable = colours_of_hubs_edge(edge.manifold, edge.part, edge.hub, both_movable);
    edge.colour = first_free_colour(low, high, usable, both_movable);
    edge.is_shared = edge.hub != k_none && edge.colour == k_overflow_colour;
    if (edge.is_shared) edge.colour = first_free_hub_colour(high_of_other);
    for (uint end = 0u; end < 2u; ++end)
        edge.obstructs[end] = edge.movable[end] && !(edge.is_shared && body_at(end) == edge.hub);
}

// Whether it was not in hand before.
bool take_in_hand(uint entry)
{
    if (entry == entry_in_hand) return false;
    entry_in_hand = entry;
    edge.pair = uncoloured[entry];
    if ((edge.pair & k_has_got) != 0u) edge.pair = k_none;
    if (edge.pair == k_none) return true;
    edge.manifold = manifolds[edge.pair];
    for (uint end = 0u; end < 2u; ++end)
        edge.movable[end] = is_movable(shapes[body_at(end)]);
    bool both_movable = edge.movable[0] && edge.movable[1];
    edge.rank = again ? class_rank(manifold_keys[edge.pair], both_movable) : edge_rank(body_at(0u), body_at(1u), both_movable);
    edge.hub = hub_of(edge.manifold);
    edge.part = 0u;
    if (edge.hub != k_none) edge.part = part_of_load(edge.manifold, uintBitsToFloat(manifold_keys[edge.pair]), edge.hub);
    return true;
}

void give_colour(uint colour)
{
    manifold_keys[edge.pair] = colour;
    uncoloured[entry_in_hand] = edge.pair | k_has_got;
    edge.pair = k_none;
}

uint edges_of(uint body)
{
    return count_edges(body_colours[body_word(body, k_used_low)], body_colours[body_word(body, k_used_high)],
                       body_colours[body_word(body, k_new_edges)]);
}

// A sleeper, whose contacts are not all listed, is none.
bool makes_hub(uint body) { return is_hub(edges_of(body), parameters) && !(args.y == 1u && substeps[body] == 0u); }

bool gives_up_colour(Manifold manifold)
{
    uint a = manifold.body_a;
    uint b = manifold.body_b;
    bool is_of_hub = makes_hub(a) || makes_hub(b);
    bool gives = gives_up(manifold.colour, edges_of(a), edges_of(b));
    if (is_lent(manifold.colour, is_movable(shapes[a]) && is_movable(shapes[b])))
        gives = gives_back(body_colours[body_word(a, k_used_high)] | body_colours[body_word(b, k_used_high)],
                           body_colours[body_word(a, k_new_edges)], body_colours[body_word(b, k_new_edges)]);
    return gives && !is_of_hub;
}

// `entry`: of what is doubtful; `end`: the first of these. What gives its colour up comes behind what has none, as long as there is
// room between the two.
void look_at_doubtful(uint entry, uint end)
{
    uint pair = uncoloured[entry] & ~k_has_kept;
    Manifold manifold = manifolds[pair];
    if (gives_up_colour(manifold)) {
        uint place = counters[k_counter_uncoloured] + atomicAdd(counters[k_counter_given_up], 1u);
        if (place >= end) return;
        uncoloured[place] = pair | k_has_kept;
    } else {
        raise_counter(k_counter_colour_demand, colours_down_to(manifold.colour));
    }
    uncoloured[entry] = k_none;
}

void give_up_colour(uint entry)
{
    uint pair = uncoloured[entry] & ~k_has_kept;
    Manifold manifold = manifolds[pair];
    uint word = used_word(manifold.colour);
    uint others = ~used_bit(manifold.colour);
    atomicAnd(body_colours[body_word(manifold.body_a, word)], others);
    atomicAnd(body_colours[body_word(manifold.body_b, word)], others);
    uncoloured[entry] = pair;
}

bool has_kept_one(uint entry) { return uncoloured[entry] != k_none && (uncoloured[entry] & k_has_kept) != 0u; }

void list_hub(uint hub)
{
    hubs[atomicAdd(counters[k_counter_hub_count], 1u)] = hub;
    bool has_kept = (body_colours[body_word(hub, k_used_low)] | body_colours[body_word(hub, k_used_high)]) != 0u;
    if (has_kept) counters[k_counter_graph_due] = k_due_twice;
}

// Whether its bodies are hubs, and the largest load on each that is.
void find_hubs(uint pair)
{
    Manifold manifold = manifolds[pair];
    bool of_a = makes_hub(manifold.body_a);
    bool of_b = makes_hub(manifold.body_b);
    uint load = of_a && of_b ? 0u : manifold_keys[pair]; // not negative: ordered as the floats
    for (uint end = 0u; end < 2u; ++end) {
        if (!(end == 0u ? of_a : of_b)) continue;
        uint body = end == 0u ? manifold.body_a : manifold.body_b;
        body_colours[body_word(body, k_hub_word)] = k_is_hub; // others write the same
        if (atomicMax(body_colours[body_word(body, k_largest_load)], largest_load_word(load)) == 0u)
            list_hub(body);
    }
}

void add_load(uint pair)
{
    Manifold manifold = manifolds[pair];
    uint hub = hub_of(manifold);
    if (hub == k_none) return;
    uint part = part_of_load(manifold, uintBitsToFloat(manifold_keys[pair]), hub);
    atomicAdd(body_colours[body_word(hub, k_whole_load)], part);
}

// That the edge has no share of a hub.
void count_unshared()
{
    for (uint end = 0u; end < 2u; ++end) {
        if (is_found_hub(body_at(end))) atomicAdd(body_colours[body_word(body_at(end), k_hub_word)], 1u);
    }
    if (edge.part > 0u) atomicAdd(body_colours[body_word(edge.hub, k_unshared_load)], edge.part);
}

void propose(uint entry, uint rank_word)
{
    take_in_hand(entry);
    if (edge.pair == k_none) return;
    find_colour();
    if (edge.colour == k_overflow_colour) { // colours are never given back
        atomicAdd(counters[k_counter_overflow_count], 1u);
        count_unshared();
        give_colour(k_overflow_colour);
        return;
    }
    for (uint end = 0u; end < 2u; ++end) {
        if (edge.obstructs[end]) atomicMax(body_colours[body_word(body_at(end), rank_word)], edge.rank);
    }
}

void decide(uint entry, uint rank_word, uint next_rank_word)
{
    bool is_new = take_in_hand(entry);
    if (edge.pair == k_none) return;
    // Another edge of its hub may have taken a colour since it proposed: the last free one is asked for again.
    if (is_new || edge.hub != k_none) find_colour();
    bool wins = edge.colour != k_overflow_colour;
    for (uint end = 0u; end < 2u; ++end) {
        if (edge.obstructs[end]) {
            wins = wins && body_colours[body_word(body_at(end), rank_word)] == edge.rank;
            body_colours[body_word(body_at(end), next_rank_word)] = 0u;
        }
    }
    if (!wins) {
        atomicAdd(left_over, 1u);
        return;
    }
    for (uint end = 0u; end < 2u; ++end) {
        if (edge.obstructs[end])
            atomicOr(body_colours[body_word(body_at(end), used_word(edge.colour))], used_bit(edge.colour));
    }
    if (!edge.is_shared) count_unshared();
    give_colour(edge.colour);
}

void colour_in_rounds(uint first, uint stride, uint entry_count)
{
    uint me = gl_LocalInvocationID.x;
    uint rank_word = k_best_rank;
    uint known_left_over = arrivals[k_all_left_over];
    for (bool done = false; !done;) {
        if (me == 0u) left_over = 0u;
        for (uint entry = first; entry < entry_count; entry += stride)
            propose(entry, rank_word);
        wait_for_workers();
        uint next_rank_word = 2u * k_best_rank + 1u - rank_word;
        for (uint entry = first; entry < entry_count; entry += stride)
            decide(entry, rank_word, next_rank_word);
        barrier();
        if (me == 0u && left_over > 0u) atomicAdd(arrivals[k_all_left_over], left_over);
        wait_for_workers();
        uint all_left_over = arrivals[k_all_left_over];
        done = all_left_over == known_left_over;
        known_left_over = all_left_over;
        rank_word = next_rank_word;
    }
}

bool has_got_one(uint entry) { return uncoloured[entry] != k_none && (uncoloured[entry] & k_has_got) != 0u; }

void begin_again(uint entry)
{
    if (!has_got_one(entry)) return;
    uint pair = uncoloured[entry] & ~k_has_got;
    uint colour = manifold_keys[pair];
    Manifold manifold = manifolds[pair];
    if (colour >= k_first_hub_colour) return; // in the overflow set
    uint others = ~used_bit(colour);
    for (uint end = 0u; end < 2u; ++end) {
        uint body = end == 0u ? manifold.body_a : manifold.body_b;
        atomicAnd(body_colours[body_word(body, used_word(colour))], others);
        body_colours[body_word(body, k_best_rank)] = 0u; // others write the same
        body_colours[body_word(body, k_best_rank + 1u)] = 0u;
    }
    uncoloured[entry] = pair;
}

// After all rounds: how many colours what has got one needs.
void note_colours(uint first, uint stride, uint entry_count)
{
    uint most = 0u;
    for (uint entry = first; entry < entry_count; entry += stride) {
        if (!has_got_one(entry)) continue;
        uint colour = manifold_keys[uncoloured[entry] & ~k_has_got];
        if (colour < k_first_hub_colour) most = max(most, colours_down_to(colour));
    }
    raise_counter(k_counter_colour_demand, most);
}

void begin_all_again(bool by_class, uint first, uint stride, uint entry_count)
{
    for (uint entry = first; entry < entry_count; entry += stride)
        begin_again(entry);
    again = by_class;
    entry_in_hand = k_none;
    wait_for_workers();
    if (first == 0u) counters[k_counter_colour_demand] = 0u; // all have read it
}

// Whether all get colours this time: by rank at first; where all are new, again by class if a few colours were enough, and by rank
// once more if they are not enough then. In uniform control flow: it may wait for workers. Compilers put what is called into each place
// that calls it, so there is one.
bool colours_all(uint time, bool all_new)
{
    if (time == 0u) return true;
    if (!all_new || time > k_times_again + 1u) return false;
    if (time > 1u && time <= k_times_again) return true;
    wait_for_workers();
    bool are_many = counters[k_counter_colour_demand] > k_many_colours;
    return are_many == (time > 1u);
}

void main()
{
    if (args.x == 1u) {
        count_resident_groups();
        return;
    }
    if (counters[k_counter_graph_bodies] == 0u) return;
    uint new_count = counters[k_counter_uncoloured];
    uint first_doubtful = counters[k_counter_graph_pairs] - counters[k_counter_doubtful];
    uint listed_count = new_count + counters[k_counter_doubtful];
    meet_for(listed_count);
    if (gl_WorkGroupID.x >= group_count) return;
    uint first = gl_GlobalInvocationID.x;
    uint stride = group_count * gl_WorkGroupSize.x;
    for (uint entry = first; entry < listed_count; entry += stride) {
        if (entry < new_count)
            find_hubs(uncoloured[entry]);
        else
            look_at_doubtful(first_doubtful + entry - new_count, first_doubtful);
    }
    wait_for_workers();
    uint entry_count = new_count + counters[k_counter_given_up];
    if (entry_count > first_doubtful) entry_count = counters[k_counter_graph_pairs]; // some are where they were
    meet_for(min(entry_count, listed_count)); // never more than have met
    if (gl_WorkGroupID.x >= group_count) return;
    stride = group_count * gl_WorkGroupSize.x;
    bool has_hubs = counters[k_counter_hub_count] > 0u;
    for (uint entry = first; entry < entry_count; entry += stride) {
        if (has_kept_one(entry))
            give_up_colour(entry);
        else if (has_hubs && uncoloured[entry] != k_none)
            add_load(uncoloured[entry]);
    }
    bool all_new = counters[k_counter_colour_demand] == 0u && !has_hubs;
    wait_for_workers();
    for (uint time = 0u; colours_all(time, all_new); ++time) {
        if (time > 0u) begin_all_again(time <= k_times_again, first, stride, entry_count);
        colour_in_rounds(first, stride, entry_count);
        note_colours(first, stride, entry_count);
    }
    for (uint i = first; i < counters[k_counter_hub_count]; i += stride) {
        uint shares = shares_of_hub(body_colours[body_word(hubs[i], k_new_edges)],
                                    body_colours[body_word(hubs[i], k_hub_word)]);
        atomicAdd(counters[k_counter_hub_manifolds], shares);
    }
}
