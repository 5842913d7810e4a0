// SPDX-License-Identifier: MIT
// CPU twin of solve_island_groups.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_islands.h"

namespace talus::engine {

void solve_groups(CpuState& state, const std::function<IslandPlaces(uint group)>& places_of) {
    const uint body_count = state.parameters.body_count, group_count = count_groups(body_count);
    const uint* const keys = state.manifold_keys.data;
    const uint* const end = keys + state.counters[k_counter_manifold_count];
    const auto first_of = [&](uint group) {
        return static_cast<uint>(std::lower_bound(keys, end, manifold_key(group, 0)) - keys);
    };
    IslandMemory& memory = island_memory(state);
    state.parallel(
        group_count,
        [&](uint i) {
            const uint group = i + 1;
            const IslandPlaces places = places_of(group);
            IslandWork work;
            for (uint place = places.first; place < places.end; ++place) {
                const uint body = state.island_bodies[place];
                if (body < body_count && state.island_places[body] == place &&
                    state.island_groups[body] == places.group)
                    work.bodies.push_back(body);
            }
            if (work.bodies.empty()) return;
            for (uint index = first_of(group), last = first_of(group + 1); index < last; ++index)
                work.add_constraint(state, index);
            solve_together(state, memory, work);
        },
        2);
}

void solve_island_groups_on_cpu(CpuState& state, const Launch& launch) {
    state.some_bounce = launch.args[0] != 0;
    solve_groups(state, [&](uint group) {
        const uint first = (group - 1) * k_group_window;
        return IslandPlaces{group, first, min(first + k_group_room, state.parameters.body_count)};
    });
}

const Kernel solve_island_groups{"resolution/solve_island_groups", solve_island_groups_on_cpu, 1};

} // namespace talus::engine
