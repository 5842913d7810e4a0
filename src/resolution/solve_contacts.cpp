// SPDX-License-Identifier: MIT
// CPU twin of solve_contacts.comp.glsl.
#include "resolution/solve_contacts.h"
#include "resolution/contact_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

void solve_contacts_on_cpu(CpuState& state, const Launch& launch) {
    const uint colour = launch.args[0], substep = launch.args[2];
    const auto pass = static_cast<ContactPass>(launch.args[1]);
    const uint first = state.colour_offsets[colour];
    const uint count = state.colour_offsets[colour + 1] - first;
    const uint grain = colour == k_overflow_colour ? UINT32_MAX : 64; // the overflow set one after the other
    state.parallel(
        count, [&](uint i) { pass_over_constraint(state, pass, substep, first + i); }, grain);
}

const Kernel solve_contacts{"resolution/solve_contacts", solve_contacts_on_cpu};

} // namespace talus::engine
