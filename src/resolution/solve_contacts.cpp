// SPDX-License-Identifier: MIT
// CPU twin of solve_contacts.comp.glsl.
#include "resolution/solve_contacts.h"

#include <numeric>

#include "resolution/resolution.h"

namespace talus::engine {

std::size_t memory_bytes(const SolverBatches& batches) {
    std::size_t bytes = batches.bodies.memory_bytes();
    for (const ConstraintBatches& each : batches.of_colours)
        bytes += each.memory_bytes();
    return bytes;
}

SolverBatches& solver_batches(CpuState& state) {
    if (state.solver_batches == nullptr) state.solver_batches = std::make_shared<SolverBatches>();
    return *state.solver_batches;
}

void solve_contacts_on_cpu(CpuState& state, const Launch& launch) {
    const uint colour = launch.args[0], tick = launch.args[2];
    const auto pass = static_cast<ContactPass>(launch.args[1]);
    const uint first = state.colour_offsets[colour];
    const uint count = state.colour_offsets[colour + 1] - first;
    if (colour == k_overflow_colour) { // one after the other
        for (uint i = 0; i < count; ++i)
            pass_over_constraint(state, pass, tick, first + i);
        return;
    }
    const uint grain = k_parallel_grain / 4 / lane_passes().lanes;
    ConstraintBatches& batches = solver_batches(state).of_colours[colour];
    if (pass == ContactPass::WarmStart) { // the first of a step
        std::vector<uint> indices(count);
        std::iota(indices.begin(), indices.end(), first);
        batches.assign(indices);
        state.parallel(
            batches.count(), [&](uint batch) { batches.take(state, batch); }, grain);
    }
    state.parallel(
        batches.count(), [&](uint batch) { batches.pass_over(state, pass, tick, batch); }, grain);
}

const Kernel solve_contacts{"resolution/solve_contacts", solve_contacts_on_cpu};

} // namespace talus::engine
