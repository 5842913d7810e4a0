// SPDX-License-Identifier: MIT
// Another engine that plays the same scene, for a comparison in one run.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/quality.h"
#include "scenes/scene.h"

namespace talus::bench {

inline constexpr std::string_view k_bullet = "bullet";

struct PeerDescription {
    std::string name, version;
    std::uint32_t threads = 1;
    std::uint32_t iterations = 0; ///< of its solver, a step
};

struct PeerCounts {
    std::uint32_t pairs = 0, manifolds = 0, contacts = 0; ///< as in StepReport
};

class Peer {
public:
    virtual ~Peer() = default;
    /// One step of the length that the settings ask for, finished on return.
    virtual void step() = 0;
    virtual PeerDescription description() const = 0;
    virtual PeerCounts counts() const = 0;
    /// In the order of the scene's bodies.
    virtual std::vector<cli::BodySample> samples() const = 0;
};

/// Throws Error where this build has no Bullet.
void require_bullet();

/// `start` holds the scene's bodies as Talus begins with them: masses and inertias are taken from there, so that both
/// engines have the same. The scene must outlive the peer.
std::unique_ptr<Peer> make_bullet(const scenes::Scene&, const Settings&, std::span<const cli::BodySample> start);

} // namespace talus::bench
