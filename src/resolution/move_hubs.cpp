// SPDX-License-Identifier: MIT
// CPU twin of move_hubs.comp.glsl.
#include <array>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {

static void move_hubs_on_cpu(CpuState& state, const Launch& launch) {
    const uint colour = launch.args[0], tick = launch.args[2];
    const uint first = state.colour_offsets[k_first_hub_colour];
    const uint begin = state.colour_offsets[colour] - first, end = state.colour_offsets[colour + 1] - first;
    state.parallel(
        state.counters[k_counter_hub_count],
        [&](uint i) {
            const uint hub = state.hubs[i];
            const BodyInertia& inertia = state.inertias[hub];
            if (substep_at(tick, inertia.traits) >= inertia.substeps || state.velocities[hub].inverse_mass == 0.0f)
                return;
            std::array<HubChange, k_hub_group> sums;
            sums.fill(no_change(hub));
            for (uint k = begin; k < end; ++k) {
                HubChange& sum = sums[(k - begin) % k_hub_group];
                const HubChange& change = state.hub_changes[k];
                if (change.body == hub && change.tick == tick) sum = add_changes(sum, change);
            }
            for (uint half_count = k_hub_group / 2; half_count > 0; half_count /= 2)
                for (uint k = 0; k < half_count; ++k)
                    sums[k] = add_changes(sums[k], sums[k + half_count]);
            state.velocities[hub] = move_hub(state.velocities[hub], sums[0]);
        },
        1);
}

const Kernel move_hubs{"resolution/move_hubs", move_hubs_on_cpu};

} // namespace talus::engine
