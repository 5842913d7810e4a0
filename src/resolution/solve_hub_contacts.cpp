// SPDX-License-Identifier: MIT
// CPU twin of solve_hub_contacts.comp.glsl.
#include "resolution/resolution.h"
#include "resolution/solve_contacts.h"

namespace talus::engine {

const Kernel solve_hub_contacts{"resolution/solve_hub_contacts", solve_contacts_on_cpu};

} // namespace talus::engine
