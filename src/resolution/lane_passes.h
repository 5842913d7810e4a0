// SPDX-License-Identifier: MIT
// The solver's passes over several items side by side: a body or a contact constraint in each lane of the CPU's vector
// registers. With the same bits as body_passes.h and contact_passes.h, which go through them one by one.
#pragma once

#include "resolution/contact_passes.h"

namespace talus::engine {

inline constexpr uint k_most_lanes = 8;

/// Both functions treat the items `indices`, at most `lanes` of them, and have a bit set in their result for each that
/// they have left alone: what is rare, as hits, is for the functions that treat one item.
struct LanePasses {
    uint lanes; ///< items side by side
    /// See pass_over_constraint. No two constraints may share a body that can be pushed, but a hub.
    uint (*over_constraints)(const CpuState&, ContactPass, uint substep, const uint* indices, uint count);
    /// See integrate_body.
    uint (*over_bodies)(const CpuState&, uint substep, const uint* indices, uint count);
};

/// For the widest registers that this machine has.
const LanePasses& lane_passes();

/// A pass over the constraints `indices`, all of one colour.
void pass_over_colour(CpuState&, ContactPass, uint substep, const uint* indices, uint count);
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
