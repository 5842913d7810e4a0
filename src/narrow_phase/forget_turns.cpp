// SPDX-License-Identifier: MIT
// CPU twin of forget_turns.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "narrow_phase/narrow_phase.h"
#include "state/formulas.h"

namespace talus::engine {

static void forget_turns_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_did_not_fit] != 0) return;
    for (uint i = 0; i < launch.args[0]; ++i) {
        BodyStart& start = state.starts[state.changes[i]];
        start = forget_turn(start);
    }
}

const Kernel forget_turns{"narrow_phase/forget_turns", forget_turns_on_cpu};

} // namespace talus::engine
