// SPDX-License-Identifier: MIT
// CPU twin of solve_contacts.comp.glsl.
#include "resolution/solve_contacts.h"

#include <array>
#include <numeric>

#include "resolution/contact_batch.h"
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
    const uint lanes = contact_batch().lanes;
    const auto pass_over_part = [&](uint part) {
        std::array<uint, k_most_lanes> indices;
        const uint begin = part * lanes, size = min(lanes, count - begin);
        std::iota(indices.begin(), indices.begin() + size, first + begin);
        pass_over_colour(state, pass, substep, indices.data(), size);
    };
    state.parallel((count + lanes - 1) / lanes, pass_over_part, 64 / lanes);
}

const Kernel solve_contacts{"resolution/solve_contacts", solve_contacts_on_cpu};

} // namespace talus::engine
