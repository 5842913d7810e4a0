// SPDX-License-Identifier: MIT
// CPU twin of solve_islands.comp.glsl.
#include <array>
#include <vector>

#include "resolution/lane_passes.h"
#include "resolution/resolution.h"
#include "resolution/solve_islands.h"

namespace talus::engine {
namespace {

/// Manifolds are sorted by island, then by colour. Each thread gets about as many of them.
std::vector<IslandWork> collect_islands(const CpuState& state) {
    const uint body_count = state.parameters.body_count;
    const uint manifold_count = state.counters[k_counter_manifold_count];
    const uint threads = state.threads->count();
    const uint share = threads == 1 ? k_none : manifold_count / (4 * threads) + 1;
    std::vector<IslandWork> parts(1);
    std::vector<uint> part_of(body_count, 0); // for each island
    uint index = 0, taken = 0;
    for (uint island = 0; island < body_count; ++island) {
        part_of[island] = static_cast<uint>(parts.size()) - 1;
        for (; index < manifold_count && island_of_key(state.manifold_keys[index]) == island; ++index, ++taken)
            parts.back().add_constraint(state, index);
        if (taken < share) continue;
        parts.emplace_back();
        taken = 0;
    }
    for (uint body = 0; body < body_count; ++body) {
        if (state.islands[body] == k_none) continue;
        IslandWork& part = parts[part_of[state.islands[body]]];
        part.bodies.push_back(body);
    }
    return parts;
}

} // namespace

void IslandWork::add_constraint(const CpuState& state, uint constraint) {
    colours[colour_of_key(state.manifold_keys[constraint])].push_back(constraint);
}

std::unique_ptr<SolverBatches> IslandMemory::take() {
    const std::lock_guard lock(mutex_);
    if (unused_.empty()) return std::make_unique<SolverBatches>();
    std::unique_ptr<SolverBatches> taken = std::move(unused_.back());
    unused_.pop_back();
    return taken;
}

void IslandMemory::give_back(std::unique_ptr<SolverBatches> batches) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(std::move(batches));
}

std::size_t IslandMemory::memory_bytes() const {
    std::size_t bytes = 0;
    for (const std::unique_ptr<SolverBatches>& each : unused_)
        bytes += engine::memory_bytes(*each);
    return bytes;
}

IslandMemory& island_memory(CpuState& state) {
    if (state.island_memory == nullptr) state.island_memory = std::make_shared<IslandMemory>();
    return *state.island_memory;
}

void solve_together(CpuState& state, IslandMemory& memory, const IslandWork& islands) {
    const Parameters& p = state.parameters;
    std::unique_ptr<SolverBatches> batches = memory.take();
    BodyBatches& bodies = batches->bodies;
    std::array<ConstraintBatches, k_overflow_colour>& colours = batches->of_colours;
    bodies.assign(islands.bodies);
    for (uint batch = 0; batch < bodies.count(); ++batch)
        bodies.take(state, batch);
    for (uint colour = 0; colour < k_overflow_colour; ++colour) {
        colours[colour].assign(islands.colours[colour]);
        for (uint batch = 0; batch < colours[colour].count(); ++batch)
            colours[colour].take(state, batch);
    }
    const auto over_contacts = [&](ContactPass pass, uint tick) {
        for (ConstraintBatches& colour : colours)
            for (uint batch = 0; batch < colour.count(); ++batch)
                colour.pass_over(state, pass, tick, batch);
        for (const uint index : islands.colours[k_overflow_colour])
            pass_over_constraint(state, pass, tick, index);
    };
    uint last = 0;
    for (const uint body : islands.bodies)
        last = max(last, state.inertias[body].substeps);
    for_each_pass(
        last, p.iterations, p.relax == 1,
        [&](uint tick) {
            for (uint batch = 0; batch < bodies.count(); ++batch)
                bodies.integrate(state, tick, batch);
        },
        over_contacts);
    memory.give_back(std::move(batches));
}

void solve_islands_on_cpu(CpuState& state, const Launch& launch) {
    state.some_bounce = launch.args[0] != 0;
    IslandMemory& memory = island_memory(state);
    const std::vector<IslandWork> parts = collect_islands(state);
    state.parallel(
        static_cast<uint>(parts.size()), [&](uint i) { solve_together(state, memory, parts[i]); }, 1);
}

const Kernel solve_islands{"resolution/solve_islands", solve_islands_on_cpu, 1};

} // namespace talus::engine
