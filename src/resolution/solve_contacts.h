// SPDX-License-Identifier: MIT
// What solve_contacts and solve_hub_contacts are on the CPU. The GPU's counterpart is solve_contacts.glsl.
#pragma once

#include <array>

#include "resolution/lane_passes.h"

namespace talus::engine {

/// What these launches, one for each colour and pass, keep from the first pass of a step to the last.
struct SolverBatches {
    std::array<ConstraintBatches, k_overflow_colour> of_colours;
};

std::size_t memory_bytes(const SolverBatches&);

void solve_contacts_on_cpu(CpuState& state, const Launch& launch);

} // namespace talus::engine
