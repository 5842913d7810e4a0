// SPDX-License-Identifier: MIT
// The launches that end a step, in order.
#include "finish/finish.h"

namespace talus::engine {

void finish(Device& device) {
    device.run({.kernel = finish_bodies, .slot = k_dispatch_bodies});
    device.swap(BufferId::Manifolds, BufferId::OldManifolds);
    device.swap(BufferId::ManifoldPoints, BufferId::OldManifoldPoints);
}

} // namespace talus::engine
