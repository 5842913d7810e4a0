// SPDX-License-Identifier: MIT
// CPU twin of gather_contact_impulses.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "finish/finish.h"
#include "state/formulas.h"

namespace talus::engine {

static void gather_contact_impulses_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_manifold_count], [&](uint index) {
        const ContactConstraint& c = state.constraints[index];
        state.contact_impulses[c.manifold].normal_impulse = c.total_impulse;
    });
}

const Kernel gather_contact_impulses{"finish/gather_contact_impulses", gather_contact_impulses_on_cpu};

} // namespace talus::engine
