// SPDX-License-Identifier: MIT
// CPU twin of finish_step.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "finish/finish.h"

namespace talus::engine {

static void finish_step_on_cpu(CpuState& state, const Launch&) {
    state.counters[k_counter_old_pair_count] = state.counters[k_counter_pair_count];
}

const Kernel finish_step{"finish/finish_step", finish_step_on_cpu, 1};

} // namespace talus::engine
