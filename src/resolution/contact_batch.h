// SPDX-License-Identifier: MIT
// The passes over contact constraints that share no body that can be pushed, several side by side: a constraint in each
// lane of the CPU's vector registers. With the same bits as contact_passes.h, which goes through them one by one.
#pragma once

#include "resolution/contact_passes.h"

namespace talus::engine {

inline constexpr uint k_most_lanes = 16;

struct ContactBatch {
    uint lanes; ///< constraints side by side
    /// Treats the constraints `indices`, at most `lanes` of them. Has a bit set in its result for each that it has left
    /// alone: what is rare, as hits and hubs, is for pass_over_constraint.
    uint (*pass)(const CpuState&, ContactPass, uint substep, const uint* indices, uint count);
};

/// For the widest registers that this machine has.
const ContactBatch& contact_batch();

/// A pass over `count` constraints of one colour.
void pass_over_colour(CpuState&, ContactPass, uint substep, const uint* indices, uint count);

} // namespace talus::engine
