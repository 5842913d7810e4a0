// SPDX-License-Identifier: MIT
// Stands in for bullet.cpp where CMake did not find Bullet.
#include "bench/peer.h"

namespace talus::bench {

void require_bullet() {
    throw Error("--peer bullet: this program was built without Bullet; install it (Debian: libbullet-dev), configure "
                "with CMake again and build");
}

std::unique_ptr<Peer> make_bullet(const scenes::Scene&, const Settings&, std::span<const cli::BodySample>) {
    require_bullet();
    return nullptr;
}

} // namespace talus::bench
