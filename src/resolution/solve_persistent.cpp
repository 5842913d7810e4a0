// SPDX-License-Identifier: MIT
// CPU twin of solve_persistent.comp.glsl: the launches that it stands for.
#include <array>

#include "resolution/contact_passes.h"
#include "resolution/resolution.h"
#include "resolution/solve_contacts.h"
#include "resolution/solve_persistent.h"

namespace talus::engine {

void solve_persistent_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_did_not_fit] != 0) return;
    const Parameters& p = state.parameters;
    const auto over_contacts = [&](ContactPass pass, uint tick) {
        for (uint colour = 0; colour <= k_overflow_colour; ++colour) {
            const std::array args{colour, static_cast<uint>(pass), tick, 0u};
            solve_contacts_on_cpu(state, {.kernel = launch.kernel, .args = args});
            if (is_hub_colour(colour)) move_hubs.twin(state, {.kernel = move_hubs, .args = args});
        }
    };
    const uint last = max(state.counters[k_counter_launched_substeps], p.least_substeps);
    const auto integrate = [&](uint tick) {
        integrate_bodies.twin(state, {.kernel = integrate_bodies, .args = {tick}});
    };
    for_each_pass(last, p.iterations, p.relax == 1, integrate, over_contacts);
}

const Kernel solve_persistent{"resolution/solve_persistent", solve_persistent_on_cpu, 256};

} // namespace talus::engine
