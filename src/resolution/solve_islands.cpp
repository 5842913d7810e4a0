// SPDX-License-Identifier: MIT
// CPU twin of solve_islands.comp.glsl.
#include "resolution/solve_islands.h"
#include "resolution/body_passes.h"
#include "resolution/contact_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

/// Those that have bodies. Manifolds are sorted by island.
static std::vector<IslandWork> collect_islands(const CpuState& state) {
    const uint body_count = state.parameters.body_count;
    std::vector<IslandWork> islands(body_count);
    for (uint body = 0; body < body_count; ++body)
        if (state.islands[body] != k_none) islands[state.islands[body]].bodies.push_back(body);
    uint index = 0;
    for (uint island = 0; island < body_count; ++island) {
        islands[island].first = index;
        while (index < state.counters[k_counter_manifold_count] &&
               state.manifold_keys[index] >> k_colour_bits == island)
            ++index;
        islands[island].end = index;
    }
    std::erase_if(islands, [](const IslandWork& island) { return island.bodies.empty(); });
    return islands;
}

void solve_island(CpuState& state, const IslandWork& island) {
    const Parameters& p = state.parameters;
    const auto over_contacts = [&](ContactPass pass, uint substep = 0) {
        for (uint index = island.first; index < island.end; ++index)
            pass_over_constraint(state, pass, substep, index);
    };
    uint last = 0;
    for (const uint body : island.bodies)
        last = max(last, state.inertias[body].substeps);
    for (uint substep = 0; substep <= last; ++substep) {
        for (const uint body : island.bodies)
            integrate_body(state, body, substep);
        if (substep == last) break;
        if (substep == 0) over_contacts(ContactPass::WarmStart);
        for (uint i = 0; i < p.iterations; ++i)
            over_contacts(i == 0 ? ContactPass::Solve : ContactPass::SolveAgain, substep);
    }
    if (p.relax == 1) over_contacts(ContactPass::Relax);
}

void solve_islands_on_cpu(CpuState& state, const Launch&) {
    const std::vector<IslandWork> islands = collect_islands(state);
    state.parallel(
        static_cast<uint>(islands.size()), [&](uint i) { solve_island(state, islands[i]); }, 2);
}

const Kernel solve_islands{"resolution/solve_islands", solve_islands_on_cpu, 1};

} // namespace talus::engine
