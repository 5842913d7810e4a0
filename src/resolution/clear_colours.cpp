// SPDX-License-Identifier: MIT
// CPU twin of clear_colours.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void clear_colours_on_cpu(CpuState& state, const Launch&) {
    std::fill_n(state.body_colours.data, std::size_t{k_body_words} * state.parameters.body_count, 0u);
}

const Kernel clear_colours{"resolution/clear_colours", clear_colours_on_cpu};

} // namespace talus::engine
