// SPDX-License-Identifier: MIT
// CPU twin of assign_colours.comp.glsl: greedy colouring in the order of ranks.
#include <algorithm>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void assign_colours_on_cpu(CpuState& state, const Launch&) {
    struct Edge {
        uint rank;
        uint pair;
    };
    std::vector<Edge> edges(state.counters[k_counter_uncoloured]);
    for (uint i = 0; i < edges.size(); ++i) {
        const uint pair = state.uncoloured[i];
        const uint a = state.manifolds[pair].body_a, b = state.manifolds[pair].body_b;
        edges[i] = {edge_rank(a, b, is_movable(state.shapes[a]) && is_movable(state.shapes[b])), pair};
    }
    std::ranges::sort(edges, std::greater{}, &Edge::rank);

    for (const Edge& edge : edges) {
        const Manifold& manifold = state.manifolds[edge.pair];
        uint low = 0, high = 0;
        for (const uint body : {manifold.body_a, manifold.body_b}) {
            if (!is_movable(state.shapes[body])) continue;
            low |= state.body_colours[body_word(body, k_used_low)];
            high |= state.body_colours[body_word(body, k_used_high)];
        }
        const uint colour = first_free_colour(low, high, state.parameters.usable_colours);
        state.manifold_keys[edge.pair] = colour;
        if (colour == k_overflow_colour) {
            ++state.counters[k_counter_overflow_count];
            continue;
        }
        state.counters[k_counter_colour_demand] = max(state.counters[k_counter_colour_demand], colour + 1);
        for (const uint body : {manifold.body_a, manifold.body_b}) {
            if (is_movable(state.shapes[body]))
                state.body_colours[body_word(body, colour < 32 ? k_used_low : k_used_high)] |= 1u << (colour & 31u);
        }
    }
}

const Kernel assign_colours{"resolution/assign_colours", assign_colours_on_cpu, 1};

} // namespace talus::engine
