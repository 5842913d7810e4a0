// SPDX-License-Identifier: MIT
// CPU twin of solve_contacts.comp.glsl.
#include "resolution/contact_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void solve_contacts_on_cpu(CpuState& state, const Launch& launch) {
    pass_over_colour(state, static_cast<ContactPass>(launch.args[1]), launch.args[0]);
}

const Kernel solve_contacts{"resolution/solve_contacts", solve_contacts_on_cpu};

} // namespace talus::engine
