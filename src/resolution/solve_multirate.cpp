// SPDX-License-Identifier: MIT
// CPU twin of solve_multirate.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_persistent.h"

namespace talus::engine {

const Kernel solve_multirate{"resolution/solve_multirate", solve_persistent_on_cpu, 256};

} // namespace talus::engine
