// SPDX-License-Identifier: MIT
// CPU twin of prepare_contacts.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "resolution/hub_load.h"
#include "resolution/lane_passes.h"
#include "resolution/resolution.h"
#include "resolution/stored_hits.h"
#include "state/formulas.h"

namespace talus::engine {

static float share_of_contact(const CpuState& state, uint pair, uint colour) {
    if (!is_hub_colour(colour)) return 1.0f;
    const Manifold& manifold = state.manifolds[pair];
    const bool of_a = (state.inertias[manifold.body_a].traits & k_trait_hub) != 0;
    const uint hub = of_a ? manifold.body_a : manifold.body_b;
    const auto word = [&](uint index) { return state.body_colours[body_word(hub, index)]; };
    return share_of_hub(part_of_load(state, pair, load_on(state, pair), hub),
                        word(k_whole_load) - word(k_unshared_load), shares_of_hub(word(k_new_edges), word(k_hub_word)));
}

static uint order_at(const CpuState& state, uint body, uint colour, uint earlier_shift, uint last_shift) {
    const uint* const words = &state.body_colours[body_word(body, 0)];
    const uint traits = state.inertias[body].traits;
    return order_at_body(is_pushed(traits), contacts_of_body(traits), words[k_used_low], words[k_used_high], colour,
                         earlier_shift, last_shift);
}

static void raise_to(uint& word, uint value) {
    const std::atomic_ref highest(word);
    for (uint before = highest.load(); before < value && !highest.compare_exchange_weak(before, value);) {
    }
}

void tell_load(const CpuState& state, const LoadBelow& load, uint height) {
    uint* const told = &state.told_loads[k_told_words * load.body];
    std::atomic_ref(told[k_told_mass]).fetch_add(load.mass, std::memory_order_relaxed);
    raise_to(told[k_told_height], height);
}

void tell_foot(const CpuState& state, const ToldFoot& foot) {
    raise_to(state.told_loads[told_foot_word(foot.body, state.parameters.body_count)], foot.rate);
}

static void prepare_contacts_on_cpu(CpuState& state, const Launch& launch) {
    const uint manifold_count = state.counters[k_counter_manifold_count];
    const auto prepare_part = [&](uint, uint first, uint end) {
        ContactToPrepare contacts[k_most_lanes];
        uint count = 0;
        for (uint entry = first; entry < end; ++entry) {
            const uint index = state.manifold_places[entry];
            if (index >= manifold_count) continue; // they do not touch, or sleep
            const uint pair = launch.args[0] == 1 ? state.listed_pairs[entry] : entry;
            const uint colour = colour_of_key(state.manifold_keys[index]);
            const Manifold& of = state.manifolds[pair];
            const uint order = order_at(state, of.body_a, colour, k_earlier_of_a, k_last_of_a) |
                               order_at(state, of.body_b, colour, k_earlier_of_b, k_last_of_b);
            contacts[count++] = {index, pair, colour, order, share_of_contact(state, pair, colour)};
            if (launch.args[1] == 1) put_contact_hits(state, index, vec4(0.0f));
        }
        if (count > 0) lane_passes().prepare_contacts(state, contacts, count);
    };
    state.parallel_parts(state.counters[k_counter_ordered_pairs], lane_passes().lanes, prepare_part,
                         k_parallel_grain / 4);
}

const Kernel prepare_contacts{"resolution/prepare_contacts", prepare_contacts_on_cpu};

} // namespace talus::engine
