// SPDX-License-Identifier: MIT
// Parity: two devices start from one state, run the same stage, and are compared buffer by buffer. Then the second
// device gets the first one's result and the next stage follows, so that a fault shows in the stage that has it.
#pragma once

#include <string>
#include <vector>

#include <talus/world.h>

namespace talus::engine {

/// How one buffer compares after one stage.
struct BufferParity {
    std::string stage;
    std::string buffer;
    std::size_t words = 0;           ///< compared
    std::size_t integers_differ = 0; ///< words that hold integers and differ
    std::size_t floats_differ = 0;   ///< words that hold floats and differ in any bit (both zeros count as one)
    double largest_error = 0.0;      ///< |a - b| / max(1, |a|, |b|) over the floats
};

struct ParityReport {
    std::vector<BufferParity> rows;
    bool integers_agree() const;
    double largest_error() const;
};

/// Floats may differ by this much, relative to their size and absolutely below 1. What was measured is 0: the formulas
/// use only operations that every device rounds alike (docs/decisions/same-bits.md).
inline constexpr double k_parity_tolerance = 1.0e-6;

/// Advances `definitions` by `steps` steps on the CPU, then makes one more step on both devices, stage by stage.
/// Buffers whose order is free (Role::Scratch) are left out.
ParityReport compare_devices(const std::vector<BodyDefinition>& definitions, const Settings&, std::uint32_t steps);

} // namespace talus::engine
