// SPDX-License-Identifier: MIT
// The solver's passes over several items side by side: a body or a contact constraint in each lane of the CPU's vector
// registers. With the same bits as body_passes.h and contact_passes.h, which go through them one by one.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "device/cpu/instruction_set.h"
#include "resolution/contact_passes.h"

namespace talus::engine {

/// A manifold whose constraint is to be made.
struct ContactToPrepare {
    uint index; ///< the constraint's
    uint manifold;
    uint colour;
    float hub_share; ///< 1 but in the colours of hubs
};

/// The functions treat the items `indices`, at most `lanes` of them. The passes have a bit set in their result for each
/// that they have left alone: what is rare, as hits, is for the functions that treat one item.
struct LanePasses {
    uint lanes;              ///< items side by side
    std::size_t batch_bytes; ///< of what is kept of as many constraints from pass to pass
    /// Writes the constraints of at most `lanes` manifolds, and tells their loads.
    void (*prepare_contacts)(const CpuState&, const ContactToPrepare*, uint count);
    /// Makes a batch of constraints that are prepared. No two may share a body that can be pushed, but a hub.
    void (*take_constraints)(const CpuState&, const uint* indices, uint count, void* batch);
    /// See pass_over_constraint.
    uint (*over_constraints)(const CpuState&, ContactPass, uint substep, void* batch);
    /// See integrate_body.
    uint (*over_bodies)(const CpuState&, uint substep, const uint* indices, uint count);
};

/// For the widest registers that this machine has.
const LanePasses& lane_passes();

/// See load_below.
void tell_load(const CpuState&, const LoadBelow&, uint height);

/// Constraints of one colour in batches, as many in each as there are lanes. What their passes need of them stays in
/// the form of lanes from the first pass of a step to the last.
class ConstraintBatches {
public:
    /// For the constraints `indices`, each batch of which is to be taken before it is passed over.
    void assign(std::vector<uint> indices);
    uint count() const { return static_cast<uint>(indices_.size() + lane_passes().lanes - 1) / lane_passes().lanes; }
    void take(const CpuState&, uint batch);
    std::size_t memory_bytes() const { return line_count_ * sizeof(Line) + indices_.capacity() * sizeof(uint); }
    void pass_over(CpuState&, ContactPass, uint substep, uint batch);

private:
    struct alignas(64) Line {
        std::byte bytes[64];
    };
    static std::size_t lines_a_batch() { return (lane_passes().batch_bytes + sizeof(Line) - 1) / sizeof(Line); }

    std::vector<uint> indices_;
    std::unique_ptr<Line[]> lines_;
    std::size_t line_count_ = 0;
};

void pass_over_bodies(CpuState&, uint substep, const uint* indices, uint count);

/// Calls part(indices, size) on all threads for parts of `first` to `first` + `count` - 1, as many items as there are
/// lanes each.
template <typename Part> void for_each_part(const CpuState& state, uint first, uint count, const Part& part) {
    const uint lanes = lane_passes().lanes;
    const auto call = [&](uint index) {
        uint indices[k_most_lanes];
        const uint begin = index * lanes, size = min(lanes, count - begin);
        for (uint i = 0; i < size; ++i)
            indices[i] = first + begin + i;
        part(static_cast<const uint*>(indices), size);
    };
    state.parallel((count + lanes - 1) / lanes, call, k_parallel_grain / 4 / lanes);
}

} // namespace talus::engine
