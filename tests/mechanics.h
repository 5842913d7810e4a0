// SPDX-License-Identifier: MIT
// What mechanics says of a whole world: momentum, angular momentum, energy. Sums are in double precision, so that they
// show the engine's errors and not their own.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "tests/bodies.h"

namespace talus::tests {

constexpr float k_gravity = 9.81f;   // m/s², that of the default settings
constexpr float k_dt = 1.0f / 60.0f; // s, likewise

/// The sub-step of a world with these settings (s).
inline float substep_of(const Settings& settings = {}) {
    return settings.dt / static_cast<float>(settings.substeps);
}

inline glm::dvec3 exact(Vec3 v) {
    return {v.x, v.y, v.z};
}
inline glm::dquat exact(Quat q) {
    return {q.w, q.x, q.y, q.z};
}
inline Vec3 rotated(Quat rotation, Vec3 v) {
    const glm::dvec3 r = exact(rotation) * exact(v);
    return {static_cast<float>(r.x), static_cast<float>(r.y), static_cast<float>(r.z)};
}

inline glm::dvec3 linear_momentum(const World& world, BodyId id) {
    return static_cast<double>(world.mass(id)) * exact(world.velocity(id).linear);
}

/// Of the body's turning alone, about its own centre.
inline glm::dvec3 spin(const World& world, BodyId id) {
    const glm::dquat q = exact(world.pose(id).rotation);
    return q * (exact(world.inertia(id)) * (glm::conjugate(q) * exact(world.velocity(id).angular)));
}

/// About the origin.
inline glm::dvec3 angular_momentum(const World& world, BodyId id) {
    return glm::cross(exact(world.pose(id).position), linear_momentum(world, id)) + spin(world, id);
}

inline double kinetic_energy(const World& world, BodyId id) {
    const Velocity velocity = world.velocity(id);
    return 0.5 * (glm::dot(linear_momentum(world, id), exact(velocity.linear)) +
                  glm::dot(spin(world, id), exact(velocity.angular)));
}

/// Kinetic and potential energy of all rigid bodies (J), with the zero of the potential at y = 0.
inline double mechanical_energy(const World& world) {
    double energy = 0.0;
    for (const BodyId id : world.bodies()) {
        if (world.kind(id) != BodyKind::Rigid) continue;
        const double height = -glm::dot(exact(world.settings().gravity), exact(world.pose(id).position));
        energy += kinetic_energy(world, id) + world.mass(id) * height;
    }
    return energy;
}

/// The largest speed of a rigid body's centre (m/s).
inline float largest_speed(const World& world) {
    float largest = 0.0f;
    for (const BodyId id : world.bodies())
        if (world.kind(id) == BodyKind::Rigid) largest = std::max(largest, length(world.velocity(id).linear));
    return largest;
}

} // namespace talus::tests
