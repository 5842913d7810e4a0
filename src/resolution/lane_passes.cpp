// SPDX-License-Identifier: MIT
#include "resolution/lane_passes.h"

#include <algorithm>

#include "device/cpu/instruction_set.h"
#include "resolution/body_passes.h"

namespace talus::engine {
namespace {

template <typename Pass, typename One> void treat(const uint* indices, uint count, const Pass& pass, const One& one) {
    const uint lanes = lane_passes().lanes;
    for (uint first = 0; first < count; first += lanes) {
        uint left_alone = pass(indices + first, std::min(lanes, count - first));
        for (; left_alone != 0; left_alone &= left_alone - 1)
            one(indices[first + static_cast<uint>(findLSB(left_alone))]);
    }
}

} // namespace

// One a file, as each is compiled for its own instructions.
extern const LanePasses lane_passes_base;
#ifdef TALUS_HAS_AVX2
extern const LanePasses lane_passes_avx2;
#endif

const LanePasses& lane_passes() {
#ifdef TALUS_HAS_AVX2
    if (has_avx2()) return lane_passes_avx2;
#endif
    return lane_passes_base;
}

void ConstraintBatches::assign(std::vector<uint> indices) {
    indices_ = std::move(indices);
    const std::size_t wanted = count() * lines_a_batch();
    if (wanted <= line_count_) return;
    lines_ = std::make_unique_for_overwrite<Line[]>(wanted);
    line_count_ = wanted;
}

void ConstraintBatches::take(const CpuState& state, uint batch) {
    const uint lanes = lane_passes().lanes, first = batch * lanes;
    const uint size = std::min(lanes, static_cast<uint>(indices_.size()) - first);
    lane_passes().take_constraints(state, &indices_[first], size, &lines_[batch * lines_a_batch()]);
}

void ConstraintBatches::pass_over(CpuState& state, ContactPass pass, uint substep, uint batch) {
    uint left_alone = lane_passes().over_constraints(state, pass, substep, &lines_[batch * lines_a_batch()]);
    for (; left_alone != 0; left_alone &= left_alone - 1)
        pass_over_constraint(state, pass, substep,
                             indices_[batch * lane_passes().lanes + static_cast<uint>(findLSB(left_alone))]);
}

void pass_over_bodies(CpuState& state, uint substep, const uint* indices, uint count) {
    treat(
        indices, count,
        [&](const uint* part, uint size) { return lane_passes().over_bodies(state, substep, part, size); },
        [&](uint body) { integrate_body(state, body, substep); });
}

} // namespace talus::engine
