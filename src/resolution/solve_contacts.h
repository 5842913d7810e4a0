// SPDX-License-Identifier: MIT
// What integrate_bodies, solve_contacts and solve_hub_contacts are on the CPU. The GPU's counterpart is
// solve_contacts.glsl.
#pragma once

#include <array>

#include "resolution/lane_passes.h"

namespace talus::engine {

/// What these launches, one for each sub-step, colour and pass, keep from the first pass of a step to the last.
struct SolverBatches {
    BodyBatches bodies; ///< of integrate_bodies
    std::array<ConstraintBatches, k_overflow_colour> of_colours;
};

SolverBatches& solver_batches(CpuState&);

std::size_t memory_bytes(const SolverBatches&);

void solve_contacts_on_cpu(CpuState& state, const Launch& launch);

} // namespace talus::engine
