// SPDX-License-Identifier: MIT
// CPU twin of plan_colours.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void plan_colours_on_cpu(CpuState& state, const Launch& launch) {
    const bool in_groups = launch.args[0] == 1;
    const Array<uint>& offsets = state.colour_offsets;
    const Array<uint>& counters = state.counters;
    const uint overflow_count = counters[k_counter_overflow_count];
    if (!in_groups && (counters[k_counter_colour_demand] > state.parameters.colour_capacity ||
                       (overflow_count > 0 && state.parameters.overflow_capacity == 0)))
        counters[k_counter_did_not_fit] |= k_fit_colours;
    if (!in_groups && counters[k_counter_substep_demand] > state.parameters.substep_capacity)
        counters[k_counter_did_not_fit] |= k_fit_substeps;

    if (counters[k_counter_hub_manifolds] > (in_groups ? 0 : state.parameters.hub_capacity))
        counters[k_counter_did_not_fit] |= k_fit_hubs;

    const uint on = counters[k_counter_did_not_fit] == 0 ? 1 : 0;
    state.dispatches[k_dispatch_bodies] = groups_for(on * state.parameters.body_count, k_group_size);
    state.dispatches[k_dispatch_manifolds] = groups_for(on * counters[k_counter_manifold_count], k_group_size);
    state.dispatches[k_dispatch_islands] = groups_for(on * state.parameters.body_count, 1);
    for (uint colour = 0; colour < k_max_colours; ++colour) {
        const uint count = in_groups ? 0 : offsets[colour + 1] - offsets[colour];
        state.dispatches[k_dispatch_colours + colour] = groups_for(on * count, k_group_size);
    }
    state.dispatches[k_dispatch_overflow] = groups_for(on * min(overflow_count, 1u), 1);
    state.dispatches[k_dispatch_hubs] = groups_for(on * counters[k_counter_hub_count], 1);
}

const Kernel plan_colours{"resolution/plan_colours", plan_colours_on_cpu, 1};

} // namespace talus::engine
