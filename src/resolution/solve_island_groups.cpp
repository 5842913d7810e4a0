// SPDX-License-Identifier: MIT
// CPU twin of solve_island_groups.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_islands.h"

namespace talus::engine {

void solve_island_groups_on_cpu(CpuState& state, const Launch&) {
    const uint body_count = state.parameters.body_count, group_count = count_groups(body_count);
    const uint* const keys = state.manifold_keys.data;
    const uint* const end = keys + state.counters[k_counter_manifold_count];
    const auto first_of = [&](uint group) {
        return static_cast<uint>(std::lower_bound(keys, end, manifold_key(group, 0)) - keys);
    };
    state.parallel(
        group_count,
        [&](uint i) {
            IslandWork work;
            const uint first_place = i * k_group_window;
            for (uint place = first_place; place < min(first_place + k_group_room, body_count); ++place) {
                const uint body = state.island_bodies[place];
                if (body < body_count && state.island_places[body] == place && state.island_groups[body] == i + 1)
                    work.bodies.push_back(body);
            }
            if (work.bodies.empty()) return;
            for (uint index = first_of(i + 1), last = first_of(i + 2); index < last; ++index)
                work.add_constraint(state, index);
            solve_together(state, work);
        },
        2);
}

const Kernel solve_island_groups{"resolution/solve_island_groups", solve_island_groups_on_cpu, 1};

} // namespace talus::engine
