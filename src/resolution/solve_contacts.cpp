// SPDX-License-Identifier: MIT
// CPU twin of solve_contacts.comp.glsl.
#include "resolution/solve_contacts.h"
#include "resolution/lane_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

void solve_contacts_on_cpu(CpuState& state, const Launch& launch) {
    const uint colour = launch.args[0], substep = launch.args[2];
    const auto pass = static_cast<ContactPass>(launch.args[1]);
    const uint first = state.colour_offsets[colour];
    const uint count = state.colour_offsets[colour + 1] - first;
    if (colour == k_overflow_colour) { // one after the other
        for (uint i = 0; i < count; ++i)
            pass_over_constraint(state, pass, substep, first + i);
        return;
    }
    for_each_part(state, first, count,
                  [&](const uint* indices, uint size) { pass_over_colour(state, pass, substep, indices, size); });
}

const Kernel solve_contacts{"resolution/solve_contacts", solve_contacts_on_cpu};

} // namespace talus::engine
