// SPDX-License-Identifier: MIT
// Fits a camera to a region exactly: each corner asks for a distance, the largest wins.
#include "scenes/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace talus::scenes {

Camera frame(const Bounds& region, Vec3 direction) {
    Camera camera;
    const glm::dvec3 lower{region.lower.x, region.lower.y, region.lower.z};
    const glm::dvec3 upper{region.upper.x, region.upper.y, region.upper.z};
    const glm::dvec3 middle = 0.5 * (lower + upper);

    const glm::dvec3 backward = glm::normalize(glm::dvec3{direction.x, direction.y, direction.z});
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3{0.0, 1.0, 0.0}, backward));
    const glm::dvec3 up = glm::cross(backward, right);

    const double tangent_up = std::tan(0.5 * camera.vertical_fov);
    const double tangent_right = tangent_up * 16.0 / 9.0;
    // A corner at depth d − p·backward before the eye is in the picture where |p·right| ≤ tangent · depth; likewise up.
    double distance = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p =
            glm::dvec3{corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y, corner & 4 ? upper.z : lower.z} -
            middle;
        const double nearness = glm::dot(p, backward);
        distance = std::max({distance, nearness + std::abs(glm::dot(p, right)) / tangent_right,
                             nearness + std::abs(glm::dot(p, up)) / tangent_up});
    }
    constexpr double k_margin = 1.08;
    const glm::dvec3 eye = middle + std::max(0.1, distance * k_margin) * backward;
    camera.eye = {static_cast<float>(eye.x), static_cast<float>(eye.y), static_cast<float>(eye.z)};
    camera.target = {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z)};
    return camera;
}

} // namespace talus::scenes
