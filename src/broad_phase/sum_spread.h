// SPDX-License-Identifier: MIT
// CPU twin of sum_spread.glsl.
#pragma once

#include <array>

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

inline SpreadSum sum_spread(const CpuState& state) {
    const uint group_count = (state.parameters.body_count + k_spread_group - 1) / k_spread_group;
    std::array<SpreadSum, k_spread_group> sums;
    sums.fill(empty_spread());
    for (uint group = 0; group < group_count; ++group)
        sums[group % k_spread_group] = add_spreads(sums[group % k_spread_group], state.spread_sums[group]);
    for (uint half_size = k_spread_group / 2; half_size > 0; half_size /= 2)
        for (uint i = 0; i < half_size; ++i)
            sums[i] = add_spreads(sums[i], sums[i + half_size]);
    return sums[0];
}

} // namespace talus::engine
