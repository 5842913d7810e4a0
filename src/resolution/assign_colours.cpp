// SPDX-License-Identifier: MIT
// CPU twin of assign_colours.comp.glsl: greedy colouring in the order of ranks.
#include <algorithm>
#include <array>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "resolution/hub_load.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void assign_colours_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_graph_bodies] == 0) return;
    const Array<uint> manifold_keys = state.words(launch.bound("ManifoldKeys"));
    struct Edge {
        uint rank;
        uint pair;
    };
    uint& colour_demand = state.counters[k_counter_colour_demand];
    const auto word_of = [&](uint body, uint word) -> uint& { return state.body_colours[body_word(body, word)]; };
    const auto movable = [&](uint body) { return is_movable(state.shapes[body]); };
    const auto are_movable = [&](const Manifold& manifold) {
        return movable(manifold.body_a) && movable(manifold.body_b);
    };
    const auto edges_of = [&](uint body) {
        return count_edges(word_of(body, k_used_low), word_of(body, k_used_high), word_of(body, k_new_edges));
    };
    const auto is_sleeper = [&](uint body) { return launch.args[1] == 1 && state.substeps[body] == 0; };
    const auto makes_hub = [&](uint body) { return is_hub(edges_of(body), state.parameters) && !is_sleeper(body); };
    const auto keeps_colour_after_all = [&](const Manifold& manifold) {
        const uint a = manifold.body_a, b = manifold.body_b;
        if (makes_hub(a) || makes_hub(b)) return true;
        if (is_lent(manifold.colour, are_movable(manifold)))
            return !gives_back(word_of(a, k_used_high) | word_of(b, k_used_high), word_of(a, k_new_edges),
                               word_of(b, k_new_edges));
        return !gives_up(manifold.colour, edges_of(a), edges_of(b));
    };
    std::vector<Edge> edges;
    std::vector<uint> given_up;
    const auto list_edge = [&](uint pair) {
        const Manifold& manifold = state.manifolds[pair];
        edges.push_back({edge_rank(manifold.body_a, manifold.body_b, are_movable(manifold)), pair});
    };
    for (uint i = 0; i < state.counters[k_counter_uncoloured]; ++i)
        list_edge(state.uncoloured[i]);
    const uint pair_count = state.counters[k_counter_graph_pairs];
    for (uint i = pair_count - state.counters[k_counter_doubtful]; i < pair_count; ++i) {
        const uint pair = state.uncoloured[i] & ~k_has_kept;
        const Manifold& manifold = state.manifolds[pair];
        if (keeps_colour_after_all(manifold)) {
            colour_demand = max(colour_demand, colours_down_to(manifold.colour));
        } else {
            list_edge(pair);
            given_up.push_back(pair);
        }
    }
    state.counters[k_counter_given_up] = static_cast<uint>(given_up.size());
    std::ranges::sort(edges, std::greater{}, &Edge::rank);
    for (const Edge& edge : edges) {
        const std::array bodies{state.manifolds[edge.pair].body_a, state.manifolds[edge.pair].body_b};
        const uint load = std::ranges::all_of(bodies, makes_hub) ? 0 : manifold_keys[edge.pair];
        for (const uint body : bodies) {
            if (!makes_hub(body)) continue;
            if (word_of(body, k_hub_word) == 0) {
                state.hubs[state.counters[k_counter_hub_count]++] = body;
                if ((word_of(body, k_used_low) | word_of(body, k_used_high)) != 0)
                    state.counters[k_counter_graph_due] = k_due_twice;
            }
            word_of(body, k_hub_word) = k_is_hub;
            uint& largest = word_of(body, k_largest_load);
            largest = max(largest, largest_load_word(load)); // not negative: ordered as the floats
        }
    }

    for (const uint pair : given_up) {
        const Manifold& manifold = state.manifolds[pair];
        for (const uint body : {manifold.body_a, manifold.body_b})
            word_of(body, used_word(manifold.colour)) &= ~used_bit(manifold.colour);
    }

    const auto of_hub = [&](uint body) { return word_of(body, k_hub_word) != 0; };
    const auto hub_of = [&](const Manifold& manifold) {
        return of_hub(manifold.body_a) ? manifold.body_a : manifold.body_b;
    };
    const auto hub_count_of = [&](const Manifold& manifold) {
        return of_hub(manifold.body_a) + of_hub(manifold.body_b);
    };
    for (const Edge& edge : edges) {
        const uint hub = hub_of(state.manifolds[edge.pair]);
        if (hub_count_of(state.manifolds[edge.pair]) == 1)
            word_of(hub, k_whole_load) +=
                part_of_load(state, edge.pair, uintBitsToFloat(manifold_keys[edge.pair]), hub);
    }

    const auto give_colour = [&](const Edge& edge) {
        const Manifold& manifold = state.manifolds[edge.pair];
        const std::array bodies{manifold.body_a, manifold.body_b};
        const bool both_movable = are_movable(manifold);
        const auto hub_count = hub_count_of(manifold);
        const uint hub = hub_of(manifold),
                   part = hub_count == 1
                              ? part_of_load(state, edge.pair, uintBitsToFloat(manifold_keys[edge.pair]), hub)
                              : 0;
        uint usable = hub_count == 0 ? state.parameters.usable_colours : 0;
        if (hub_count == 1) usable = colours_of_hubs_edge(state, manifold, part, hub, both_movable);
        uint low = 0, high = 0, high_of_other = 0;
        for (const uint body : bodies) {
            if (!movable(body)) continue;
            low |= word_of(body, k_used_low);
            high |= word_of(body, k_used_high);
            if (!of_hub(body)) high_of_other = word_of(body, k_used_high);
        }
        uint colour = first_free_colour(low, high, usable, both_movable);
        if (hub_count == 1 && colour == k_overflow_colour) colour = first_free_hub_colour(high_of_other);
        const bool is_shared = is_hub_colour(colour);
        manifold_keys[edge.pair] = colour;
        for (const uint body : bodies) {
            if (!is_shared && of_hub(body)) ++word_of(body, k_hub_word);
            const bool obstructs = movable(body) && !(is_shared && of_hub(body));
            if (colour != k_overflow_colour && obstructs) word_of(body, used_word(colour)) |= used_bit(colour);
        }
        if (!is_shared && hub_count == 1) word_of(hub, k_unshared_load) += part;
        if (colour == k_overflow_colour)
            ++state.counters[k_counter_overflow_count];
        else if (is_shared)
            ++state.counters[k_counter_hub_manifolds];
    };
    std::ranges::for_each(edges, give_colour);

    const auto demand_of_edges = [&] {
        uint most = 0;
        for (const Edge& edge : edges) {
            const uint colour = manifold_keys[edge.pair];
            if (colour < k_first_hub_colour) most = max(most, colours_down_to(colour));
        }
        return most;
    };
    const auto colour_all = [&](bool by_class) {
        std::vector<Edge> again;
        for (const Edge& edge : edges) {
            const Manifold& manifold = state.manifolds[edge.pair];
            const uint colour = manifold_keys[edge.pair];
            if (colour >= k_first_hub_colour) continue;
            again.push_back({by_class ? class_rank(colour, are_movable(manifold)) : edge.rank, edge.pair});
            for (const uint body : {manifold.body_a, manifold.body_b})
                word_of(body, used_word(colour)) &= ~used_bit(colour);
        }
        std::ranges::stable_sort(again, std::greater{}, &Edge::rank);
        std::ranges::for_each(again, give_colour);
    };
    const bool all_new = colour_demand == 0 && state.counters[k_counter_hub_count] == 0;
    if (all_new && demand_of_edges() <= k_many_colours) {
        for (uint times = 0; times < k_times_again; ++times)
            colour_all(true);
        if (demand_of_edges() > k_many_colours) colour_all(false);
    }
    colour_demand = max(colour_demand, demand_of_edges());
}

const Kernel assign_colours{"resolution/assign_colours", assign_colours_on_cpu, 1};

} // namespace talus::engine
