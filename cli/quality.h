// SPDX-License-Identifier: MIT
// How good a simulation is, measured from nothing but where the bodies are and how they move. docs/report.md says what
// each figure means.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <talus/world.h>

#include "scenes/scene.h"

namespace talus::cli {

/// One body as the measurement sees it.
struct BodySample {
    BodyKind kind = BodyKind::Rigid;
    Shape shape;
    Pose pose;
    Velocity velocity;
    float mass = 0.0f; ///< kg; not used for static and kinematic bodies
    Vec3 inertia;      ///< principal moments about the body's axes, kg·m²
    bool sensor = false;
};

/// Of dynamic bodies, if nothing else is said. Bodies with a non-finite number are counted and otherwise left out.
struct Quality {
    double max_penetration = 0.0;  ///< m, of any two bodies of which at least one is dynamic and neither a sensor
    double mean_penetration = 0.0; ///< m, over the pairs that overlap; 0 where none does
    std::uint64_t overlapping_pairs = 0;
    double max_drift = 0.0;                   ///< m, largest distance of a centre from its start
    double max_drift_sideways = 0.0;          ///< m, the horizontal part alone
    double kinetic_energy = 0.0;              ///< J, rotation included
    double max_speed = 0.0;                   ///< m/s
    std::array<double, 3> linear_momentum{};  ///< kg·m/s
    std::array<double, 3> angular_momentum{}; ///< kg·m²/s about the origin
    std::uint64_t nonfinite_bodies = 0;       ///< of any kind
    std::uint64_t escaped_bodies = 0;         ///< with the centre outside the scene's bounds
};

/// In the order of `World::bodies()`.
std::vector<BodySample> sample_bodies(const World&);

/// `starts` holds where the scene put each body, in the same order as `bodies`.
Quality measure_quality(std::span<const BodySample> bodies, std::span<const Vec3> starts, const scenes::Bounds&);

} // namespace talus::cli
