// SPDX-License-Identifier: MIT
// CPU twin of key_manifolds.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void key_manifolds_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> keys = state.words(launch.bound("Keys"));
    const Array<uint> manifold_keys = state.words(launch.bound("ManifoldKeys"));
    for (uint entry = 0; entry < state.counters[k_counter_graph_pairs]; ++entry) {
        const uint pair = launch.args[0] == 1 ? state.listed_pairs[entry] : entry;
        uint& key = keys[entry];
        const uint colour = manifold_keys[pair];
        if (colour == k_inactive_colour) {
            key = inactive_key(state.parameters.body_count);
            continue;
        }
        const Manifold& manifold = state.manifolds[pair];
        const uint body = state.islands[manifold.body_a] != k_none ? manifold.body_a : manifold.body_b;
        if (state.islands[body] == k_none) { // it wakes with the colour that it has
            key = inactive_key(state.parameters.body_count);
            ++state.counters[k_counter_sleeping_manifolds];
            continue;
        }
        const uint group = group_number(state.island_groups[body]);
        if (group != k_launched) {
            key = manifold_key(group, colour);
            continue;
        }
        const bool in_order = (state.substeps[body] & k_multirate) != 0 && colour < k_first_hub_colour;
        const uint substeps = multirate_substeps(substeps_of(manifold.demand), foot_rate_of(manifold.demand),
                                                 (state.substeps[body] & k_multirate_tall) != 0, state.parameters);
        key = launched_key(colour, in_order ? slowness_at(state.counters[k_counter_launched_substeps], substeps) : 0);
        uint& colours = state.counters[k_counter_launched_colours];
        if (colour < k_first_hub_colour) colours = max(colours, colours_down_to(colour));
        if (colour == k_overflow_colour) ++state.counters[k_counter_launched_overflow];
    }
}

const Kernel key_manifolds{"resolution/key_manifolds", key_manifolds_on_cpu};

} // namespace talus::engine
