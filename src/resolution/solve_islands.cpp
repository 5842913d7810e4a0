// SPDX-License-Identifier: MIT
// CPU twin of solve_islands.comp.glsl.
#include "resolution/body_passes.h"
#include "resolution/contact_passes.h"
#include "resolution/resolution.h"

namespace talus::engine {

static void solve_islands_on_cpu(CpuState& state, const Launch& launch) {
    // Islands do not touch each other, so it is all the same whether they take their passes together or apart.
    const Parameters& p = state.parameters;
    const auto over_bodies = [&](const auto& pass) {
        for (uint body = 0; body < p.body_count; ++body)
            pass(state, body);
    };
    const auto over_contacts = [&](ContactPass pass) {
        for (uint index = 0; index < state.counters[k_counter_manifold_count]; ++index)
            pass_over_constraint(state, pass, index);
    };
    for (uint substep = 0; substep < p.substeps; ++substep) {
        over_bodies(integrate_body_velocity);
        if (substep == 0) over_contacts(ContactPass::WarmStart);
        for (uint i = 0; i < p.iterations; ++i)
            over_contacts(ContactPass::Solve);
        over_bodies(integrate_body_position);
        if (p.relax == 1) over_contacts(ContactPass::Relax);
    }
    if (launch.args[0] == 1) over_contacts(ContactPass::Restitution);
}

const Kernel solve_islands{"resolution/solve_islands", solve_islands_on_cpu, 1};

} // namespace talus::engine
