// SPDX-License-Identifier: MIT
// CPU twin of measure_spread.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static void measure_spread_on_cpu(CpuState& state, const Launch&) {
    const uint body_count = state.counters[k_counter_search_count];
    const uint group_count = (body_count + k_spread_group - 1) / k_spread_group;
    const auto sum_group = [&](uint group) {
        std::array<SpreadSum, k_spread_group> sums;
        for (uint i = 0; i < k_spread_group; ++i) {
            const uint body = group * k_spread_group + i;
            sums[i] = body < body_count ? spread_of(state.aabbs[body]) : empty_spread();
        }
        for (uint half_size = k_spread_group / 2; half_size > 0; half_size /= 2)
            for (uint i = 0; i < half_size; ++i)
                sums[i] = add_spreads(sums[i], sums[i + half_size]);
        state.spread_sums[group] = sums[0];
    };
    state.parallel(group_count, sum_group, 4);
}

const Kernel measure_spread{"broad_phase/measure_spread", measure_spread_on_cpu, k_spread_group};

} // namespace talus::engine
