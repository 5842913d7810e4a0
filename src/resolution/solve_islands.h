// SPDX-License-Identifier: MIT
// What the kernels that solve islands in work groups are on the CPU. The GPU's counterpart is solve_in_group.glsl.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "resolution/solve_contacts.h"
#include "state/formulas.h"

namespace talus::engine {

/// Islands that one thread solves together: as they do not touch each other, they may make their passes in step, and
/// one alone has few contacts of a colour.
struct IslandWork {
    std::vector<uint> bodies;
    std::array<std::vector<uint>, k_overflow_colour + 1> colours; ///< constraints, the overflow set last

    void add_constraint(const CpuState&, uint constraint);
};

/// The batches of islands that are solved at a time, kept from step to step: memory that is new is slow.
class IslandMemory {
public:
    std::unique_ptr<SolverBatches> take();
    void give_back(std::unique_ptr<SolverBatches>);
    std::size_t memory_bytes() const; ///< between steps, when all have been given back

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<SolverBatches>> unused_;
};

IslandMemory& island_memory(CpuState&);

/// All sub-steps. Islands may have different numbers of them.
void solve_together(CpuState& state, IslandMemory&, const IslandWork&);

/// Where the bodies of a group stand in the order of islands, and what IslandGroups says of them; by default there are
/// none.
struct IslandPlaces {
    uint group = k_launched;
    uint first = 0, end = 0;
};

/// Each group of islands in a large world, those that are solved together in it.
void solve_groups(CpuState& state, const std::function<IslandPlaces(uint group)>& places_of);

void solve_islands_on_cpu(CpuState& state, const Launch& launch);
void solve_island_groups_on_cpu(CpuState& state, const Launch& launch);
void solve_single_islands_on_cpu(CpuState& state, const Launch& launch);

} // namespace talus::engine
