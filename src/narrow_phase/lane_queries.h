// SPDX-License-Identifier: MIT
// The separating axis of several pairs of boxes side by side: a pair in each lane of the CPU's vector registers. With
// the same bits as query_axes() of one pair.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// Two boxes, and the axis of their last manifold.
struct AxisQuestion {
    uint body_a;
    uint body_b;
    uint old_axis;
};

struct LaneQueries {
    uint lanes; ///< pairs side by side
    /// Answers as many questions as there are lanes.
    void (*query_axes)(const CpuState&, const AxisQuestion*, AxisQuery*);
};

/// Answers one question after the other, with the widest registers that this machine has.
void query_axes(const CpuState&, const AxisQuestion*, uint count, AxisQuery*);

} // namespace talus::engine
