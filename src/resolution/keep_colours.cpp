// SPDX-License-Identifier: MIT
// CPU twin of keep_colours.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/hub_load.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void keep_colours_on_cpu(CpuState& state, const Launch& launch) {
    const bool is_listed = launch.args[0] == 1;
    const Array<uint> manifold_keys = state.words(launch.bound("ManifoldKeys"));
    const auto use_colour = [&](uint body, uint colour) {
        if (!is_movable(state.shapes[body])) return;
        state.body_colours[body_word(body, used_word(colour))] |= used_bit(colour);
    };
    const auto want_colour = [&](uint body, bool is_on_ground) {
        if (!is_movable(state.shapes[body])) return;
        uint& new_edges = state.body_colours[body_word(body, k_new_edges)];
        new_edges = (new_edges + 1) | (is_on_ground ? k_new_on_ground : 0);
    };
    const auto is_between_sleepers = [&](const Manifold& manifold) {
        return is_listed && state.islands[manifold.body_a] == k_none && state.islands[manifold.body_b] == k_none;
    };
    const uint pair_count = state.counters[k_counter_graph_pairs];
    for (uint entry = 0; entry < pair_count; ++entry) {
        const uint pair = is_listed ? state.listed_pairs[entry] : entry;
        const Manifold& manifold = state.manifolds[pair];
        uint colour = k_inactive_colour;
        if (is_active(manifold)) {
            const bool sleeps = is_between_sleepers(manifold); // and keeps its colour whatever that is
            ++state.counters[k_counter_manifold_count];
            state.counters[k_counter_contact_count] += manifold.point_count;
            uint& substep_demand = state.counters[k_counter_substep_demand];
            if (!sleeps) substep_demand = max(substep_demand, substeps_of(manifold.demand));
            colour = manifold.colour;
            const bool both_movable =
                is_movable(state.shapes[manifold.body_a]) && is_movable(state.shapes[manifold.body_b]);
            if (colour < state.parameters.usable_colours) {
                use_colour(manifold.body_a, colour);
                use_colour(manifold.body_b, colour);
                uint& demand = state.counters[k_counter_colour_demand];
                if (!sleeps && (is_far_down(colour) || is_lent(colour, both_movable)))
                    state.uncoloured[pair_count - ++state.counters[k_counter_doubtful]] = pair | k_has_kept;
                else if (!sleeps)
                    demand = max(demand, colours_down_to(colour));
            } else if (!sleeps) {
                colour = floatBitsToUint(load_on(state, pair));
                state.uncoloured[state.counters[k_counter_uncoloured]++] = pair;
                want_colour(manifold.body_a, !both_movable);
                want_colour(manifold.body_b, !both_movable);
            }
        }
        manifold_keys[pair] = colour;
    }
}

const Kernel keep_colours{"resolution/keep_colours", keep_colours_on_cpu, k_count_group};

} // namespace talus::engine
