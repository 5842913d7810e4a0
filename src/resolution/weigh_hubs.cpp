// SPDX-License-Identifier: MIT
// CPU twin of weigh_hubs.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/hub_load.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void weigh_hubs_on_cpu(CpuState& state, const Launch&) {
    const auto word_of = [&](uint body, uint word) -> uint& { return state.body_colours[body_word(body, word)]; };
    for (uint i = 0; i < state.counters[k_counter_hub_count]; ++i) {
        word_of(state.hubs[i], k_largest_load) = largest_load_word(0);
        word_of(state.hubs[i], k_whole_load) = word_of(state.hubs[i], k_unshared_load) = 0;
    }
    if (state.counters[k_counter_hub_count] == 0) return;
    const auto for_each_edge = [&](const auto& treat) {
        for (uint pair = 0; pair < state.counters[k_counter_pair_count]; ++pair) {
            const Manifold& manifold = state.manifolds[pair];
            if (!is_active(manifold)) continue;
            const uint hub = hub_of(state, manifold);
            if (hub != k_none) treat(pair, manifold, hub);
        }
    };
    for_each_edge([&](uint pair, const Manifold&, uint hub) {
        uint& largest = word_of(hub, k_largest_load);
        state.uncoloured[pair] = floatBitsToUint(load_on(state, pair));
        largest = max(largest, largest_load_word(state.uncoloured[pair]));
    });
    const auto part_of = [&](uint pair, uint hub) {
        return part_of_load(state, pair, uintBitsToFloat(state.uncoloured[pair]), hub);
    };
    for_each_edge([&](uint pair, const Manifold&, uint hub) { word_of(hub, k_whole_load) += part_of(pair, hub); });
    for_each_edge([&](uint pair, const Manifold& manifold, uint hub) {
        const bool both_movable =
            is_movable(state.shapes[manifold.body_a]) && is_movable(state.shapes[manifold.body_b]);
        const uint part = part_of(pair, hub), usable = colours_of_hubs_edge(state, manifold, part, hub, both_movable);
        if (!keeps_colour(manifold.colour, usable, both_movable, state.parameters))
            state.counters[k_counter_graph_due] = 1;
        if (!is_hub_colour(manifold.colour)) word_of(hub, k_unshared_load) += part;
    });
}

const Kernel weigh_hubs{"resolution/weigh_hubs", weigh_hubs_on_cpu, 1};

} // namespace talus::engine
