// SPDX-License-Identifier: MIT
// What solve_contacts and solve_hub_contacts are on the CPU. The GPU's counterpart is solve_contacts.glsl.
#pragma once

#include "device/cpu/cpu_state.h"

namespace talus::engine {

void solve_contacts_on_cpu(CpuState& state, const Launch& launch);

} // namespace talus::engine
