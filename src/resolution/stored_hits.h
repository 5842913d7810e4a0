// SPDX-License-Identifier: MIT
// What hits have to know of bodies, and the hits of contacts, for the CPU: behind the warm starts of all bodies, where
// CpuState::some_bounce says so. The GPU's counterpart is stored_hits.glsl.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

inline BodyHits hits_of(const CpuState& state, uint body) {
    return std::bit_cast<BodyHits>(state.warm_starts[hits_place(body, state.parameters.body_count)]);
}

inline void put_hits(const CpuState& state, uint body, const BodyHits& hits) {
    state.warm_starts[hits_place(body, state.parameters.body_count)] = std::bit_cast<BodyWarmStart>(hits);
}

using TwoHits = std::array<vec4, 2>; // that share a record

inline vec4 hits_of_contact(const CpuState& state, uint index) {
    const uint place = contact_hits_place(index, state.parameters.body_count);
    return std::bit_cast<TwoHits>(state.warm_starts[place])[are_first_hits(index) ? 0 : 1];
}

inline void put_contact_hits(const CpuState& state, uint index, const vec4& hits) {
    BodyWarmStart& record = state.warm_starts[contact_hits_place(index, state.parameters.body_count)];
    std::memcpy(reinterpret_cast<std::byte*>(&record) + (are_first_hits(index) ? 0 : sizeof(vec4)), &hits,
                sizeof(vec4));
}

} // namespace talus::engine
