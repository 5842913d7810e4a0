// SPDX-License-Identifier: MIT
// CPU twin of report_contact_ends.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "finish/finish.h"
#include "state/formulas.h"

namespace talus::engine {

static void report_contact_ends_on_cpu(CpuState& state, const Launch& launch) {
    for (uint pair = 0; pair < state.counters[k_counter_old_pair_count]; ++pair) {
        if (state.old_contact_states[pair] != k_contact_touches) continue;
        const uint place = state.counters[k_counter_report_count]++;
        state.contact_reports[place] = make_report(state.old_manifolds[pair], k_phase_end);
        if (place >= launch.args[1]) state.counters[k_counter_did_not_fit] |= k_fit_reports;
    }
}

const Kernel report_contact_ends{"finish/report_contact_ends", report_contact_ends_on_cpu};

} // namespace talus::engine
