// SPDX-License-Identifier: MIT
// CPU twin of find_islands.comp.glsl: union-find with the lower slot as the root.
#include <numeric>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "resolution/island_roots.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void find_islands_on_cpu(CpuState& state, const Launch& launch) {
    const uint body_count = state.parameters.body_count;
    const uint pair_count = state.counters[k_counter_pair_count];
    std::vector<uint> roots(body_count);
    std::iota(roots.begin(), roots.end(), 0u);

    std::vector<bool> touches(body_count, false);
    for (uint pair = 0; pair < pair_count && launch.args[0] == 0; ++pair) {
        const Manifold& manifold = state.manifolds[pair];
        if (!is_active(manifold)) continue;
        touches[manifold.body_a] = touches[manifold.body_b] = true;
        if (is_movable(state.shapes[manifold.body_a]) && is_movable(state.shapes[manifold.body_b]))
            join_islands_of(roots, manifold.body_a, manifold.body_b);
    }
    // Bodies that touch nothing share an island; and so do all, if all are to be one.
    uint first_mover = k_none;
    for (uint body = 0; body < body_count; ++body) {
        if (touches[body] || !is_mover(state.shapes[body])) continue;
        first_mover = min(first_mover, body);
        join_islands_of(roots, body, first_mover);
    }

    for (uint body = 0; body < body_count; ++body) {
        state.islands[body] = is_mover(state.shapes[body]) ? root_of(roots, body) : k_none;
        state.substeps[body] = state.parameters.least_substeps;
    }
    for (uint pair = 0; pair < pair_count; ++pair) {
        const uint colour = state.manifold_keys[pair];
        uint island = k_island_bodies; // after all others
        if (colour != k_inactive_colour) {
            const Manifold& manifold = state.manifolds[pair];
            island = state.islands[is_movable(state.shapes[manifold.body_a]) ? manifold.body_a : manifold.body_b];
            state.substeps[island] = max(state.substeps[island], manifold.substeps);
        }
        if (launch.args[1] == 1) state.manifold_keys[pair] = manifold_key(island, colour);
    }
    for (uint body = 0; body < body_count; ++body) // an island's lowest slot comes first, and has its number
        state.substeps[body] = state.islands[body] == k_none ? 0 : state.substeps[state.islands[body]];
}

const Kernel find_islands{"resolution/find_islands", find_islands_on_cpu, 1};

} // namespace talus::engine
