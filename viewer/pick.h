// SPDX-License-Identifier: MIT
// Which body a ray meets first.
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include <talus/world.h>

namespace talus::viewer {

struct Ray {
    glm::vec3 origin{0.0f};
    glm::vec3 direction{0.0f, 0.0f, -1.0f}; ///< unit
};

struct Hit {
    BodyId body;
    float distance = 0.0f; ///< m, along the ray
    glm::vec3 point{0.0f}; ///< m, world
    glm::vec3 normal{0.0f};
};

/// Where a ray enters a shape; nothing where it misses, or begins inside.
std::optional<Hit> meet(const Ray&, const Shape&, const Pose&);

/// The nearest body that the ray enters; sensors, which nothing touches, do not count. Reads all poses.
std::optional<Hit> pick(const World&, const Ray&);

} // namespace talus::viewer
