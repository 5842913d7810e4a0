// SPDX-License-Identifier: MIT
// What hits have to know of bodies, for the CPU: behind the warm starts of all bodies, where CpuState::some_bounce says
// so. The GPU's counterpart is stored_hits.glsl.
#pragma once

#include <bit>

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

inline BodyHits hits_of(const CpuState& state, uint body) {
    return std::bit_cast<BodyHits>(state.warm_starts[hits_place(body, state.parameters.body_count)]);
}

inline void put_hits(const CpuState& state, uint body, const BodyHits& hits) {
    state.warm_starts[hits_place(body, state.parameters.body_count)] = std::bit_cast<BodyWarmStart>(hits);
}

} // namespace talus::engine
