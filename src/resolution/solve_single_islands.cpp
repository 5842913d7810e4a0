// SPDX-License-Identifier: MIT
// CPU twin of solve_single_islands.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_islands.h"

namespace talus::engine {

void solve_single_islands_on_cpu(CpuState& state, const Launch& launch) {
    state.some_bounce = launch.args[0] != 0;
    solve_groups(state, [&](uint group) {
        const uint place = (group - 1) * k_group_window;
        const uint body = state.island_bodies[place];
        const uint body_count = state.parameters.body_count;
        const bool is_here = body < body_count && state.island_places[body] == place;
        if (!is_here || state.island_groups[body] != single_group(group)) return IslandPlaces{};
        const uint first = state.island_starts[state.islands[body]];
        return IslandPlaces{single_group(group), first, min(first + k_most_single, body_count)};
    });
}

const Kernel solve_single_islands{"resolution/solve_single_islands", solve_single_islands_on_cpu, 1};

} // namespace talus::engine
