// SPDX-License-Identifier: MIT
// CPU twin of find_islands.comp.glsl: union-find with the lower slot as the root.
#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "resolution/island_roots.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void find_islands_on_cpu(CpuState& state, const Launch& launch) {
    const uint body_count = state.counters[k_counter_graph_bodies];
    const uint pair_count = state.counters[k_counter_graph_pairs];
    if (body_count == 0) return;
    const Array<uint> manifold_keys = state.words(launch.bound("ManifoldKeys"));
    std::vector<uint> roots(body_count);
    std::iota(roots.begin(), roots.end(), 0u);

    const bool one_island = launch.args[0] == 1;
    const auto movable = [&](uint body) { return is_movable(state.shapes[body]); };
    std::vector<bool> touches(body_count, false), restless(body_count);
    for (uint body = 0; body < body_count; ++body)
        restless[body] = is_restless(state.poses[body], state.velocities[body], state.shapes[body], state.parameters);
    // One island of all that is awake: which that is the true islands tell, where anything may sleep.
    const bool join = !one_island || state.parameters.rest_steps > 0;
    for (uint pair = 0; pair < pair_count && join; ++pair) {
        const Manifold& manifold = state.manifolds[pair];
        const uint a = manifold.body_a, b = manifold.body_b;
        if (!is_active(manifold)) continue;
        touches[a] = touches[b] = true;
        if (movable(a) && movable(b)) join_islands_of(roots, a, b, std::identity{});
        if (!movable(a) && restless[a]) restless[b] = true;
        if (!movable(b) && restless[b]) restless[a] = true;
    }
    for (uint body = 0; body < body_count; ++body)
        if (movable(body) && restless[body]) restless[root_of(roots, body)] = true;
    const auto is_awake = [&](uint body) {
        return is_mover(state.shapes[body]) && (!movable(body) || restless[root_of(roots, body)]);
    };
    // Bodies that touch nothing share an island; and so do all, if all are to be one.
    uint first_mover = k_none;
    for (uint body = 0; body < body_count; ++body) {
        state.islands[body] = is_awake(body) ? root_of(roots, body) : k_none;
        state.substeps[body] = state.parameters.least_substeps;
        if (state.islands[body] == k_none || (touches[body] && !one_island)) continue;
        first_mover = min(first_mover, body);
        state.islands[body] = first_mover;
    }
    std::vector<uint> manifold_counts(body_count, 0);
    for (uint pair = 0; pair < pair_count; ++pair) {
        uint colour = manifold_keys[pair];
        uint island = k_island_bodies; // after all others
        if (colour != k_inactive_colour) {
            Manifold& manifold = state.manifolds[pair];
            island = state.islands[movable(manifold.body_a) ? manifold.body_a : manifold.body_b];
            if (island != k_none) {
                state.substeps[island] = max(state.substeps[island], substeps_of(manifold.demand));
                ++manifold_counts[island];
            } else { // it sleeps, and wakes with the colour that it has
                manifold.colour = colour;
                ++state.counters[k_counter_sleeping_manifolds];
                island = k_island_bodies;
                colour = k_inactive_colour;
            }
        }
        manifold_keys[pair] = launch.args[1] == 1 ? manifold_key(island, colour) : colour;
    }
    for (uint body = 0; body < body_count; ++body) // an island's lowest slot comes first, and has its number
        state.substeps[body] = state.islands[body] == k_none ? 0 : state.substeps[state.islands[body]];
    state.counters[k_counter_largest_island] = *std::ranges::max_element(manifold_counts);
}

const Kernel find_islands{"resolution/find_islands", find_islands_on_cpu, 1};

} // namespace talus::engine
