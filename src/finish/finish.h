// SPDX-License-Identifier: MIT
// Finish: poses move on, and the step's results become the last step's.
#pragma once

#include "device/device.h"

namespace talus::engine {

/// Manifolds and OldManifolds change places (and their points), also where the step did not fit.
void finish(Device&);

extern const Kernel finish_bodies;

} // namespace talus::engine
