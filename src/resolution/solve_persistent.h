// SPDX-License-Identifier: MIT
// What the twins of solve_persistent and solve_multirate share.
#pragma once

#include "device/cpu/cpu_state.h"

namespace talus::engine {

void solve_persistent_on_cpu(CpuState&, const Launch&);

} // namespace talus::engine
