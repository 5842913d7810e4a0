// SPDX-License-Identifier: MIT
#include "resolution/lane_passes.h"

#include <algorithm>

#include "device/cpu/instruction_set.h"
#include "resolution/body_passes.h"

namespace talus::engine {
TALUS_DECLARE_OF_SETS(LanePasses, lane_passes);

const LanePasses& lane_passes() {
    return TALUS_FOR_THIS_MACHINE(lane_passes);
}

void Batches::assign(std::span<const uint> indices, std::size_t batch_bytes) {
    indices_.assign(indices.begin(), indices.end());
    lines_a_batch_ = (batch_bytes + sizeof(Line) - 1) / sizeof(Line);
    const std::size_t wanted = count() * lines_a_batch_;
    if (wanted <= line_count_) return;
    lines_ = std::make_unique_for_overwrite<Line[]>(wanted);
    line_count_ = wanted;
}

uint Batches::size_of(uint batch) const {
    const uint lanes = lane_passes().lanes;
    return std::min(lanes, static_cast<uint>(indices_.size()) - batch * lanes);
}

void ConstraintBatches::take(const CpuState& state, uint batch) {
    lane_passes().take_constraints(state, indices_of(batch), size_of(batch), memory_of(batch));
}

void ConstraintBatches::pass_over(CpuState& state, ContactPass pass, uint tick, uint batch) {
    uint left_alone = lane_passes().pass_over_constraints(state, pass, tick, memory_of(batch));
    for (; left_alone != 0; left_alone &= left_alone - 1)
        pass_over_constraint(state, pass, tick, indices_of(batch)[findLSB(left_alone)]);
}

void BodyBatches::take(const CpuState& state, uint batch) {
    lane_passes().take_bodies(state, indices_of(batch), size_of(batch), memory_of(batch));
}

void BodyBatches::integrate(CpuState& state, uint tick, uint batch) {
    uint left_alone = lane_passes().integrate_bodies(state, tick, memory_of(batch));
    for (; left_alone != 0; left_alone &= left_alone - 1)
        integrate_body(state, indices_of(batch)[findLSB(left_alone)], tick);
}

} // namespace talus::engine
