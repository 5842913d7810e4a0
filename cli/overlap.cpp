// SPDX-License-Identifier: MIT
// Box against box by the separating axis theorem (Gottschalk, Lin and Manocha 1996): the shortest way out of an overlap
// of two boxes is along one of 15 directions, the 3 + 3 face normals and the 9 products of their edges.
#include "overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace talus::cli {
namespace {

/// Half the length of a box's shadow on a unit direction.
double radius_along(const PlacedShape& box, const glm::dvec3& direction) {
    return box.half.x * std::abs(glm::dot(direction, box.axes[0])) +
           box.half.y * std::abs(glm::dot(direction, box.axes[1])) +
           box.half.z * std::abs(glm::dot(direction, box.axes[2]));
}

double overlap_along(const PlacedShape& a, const PlacedShape& b, const glm::dvec3& direction) {
    return radius_along(a, direction) + radius_along(b, direction) - std::abs(glm::dot(b.centre - a.centre, direction));
}

double boxes(const PlacedShape& a, const PlacedShape& b) {
    double depth = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        depth = std::min(depth, overlap_along(a, b, a.axes[i]));
        depth = std::min(depth, overlap_along(a, b, b.axes[i]));
        if (depth <= 0.0) return depth;
    }
    // The overlap along any direction is at least the depth, so a product of nearly parallel edges, whose direction is
    // mostly rounding, can only be of no use. The threshold just keeps the division sound.
    constexpr double k_parallel = 1e-20;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const glm::dvec3 product = glm::cross(a.axes[i], b.axes[j]);
            const double squared = glm::dot(product, product);
            if (squared > k_parallel) depth = std::min(depth, overlap_along(a, b, product / std::sqrt(squared)));
        }
        if (depth <= 0.0) return depth;
    }
    return depth;
}

double sphere_and_box(const PlacedShape& sphere, const PlacedShape& box) {
    const glm::dvec3 centre = (sphere.centre - box.centre) * box.axes; // row times matrix: into the box's axes
    const glm::dvec3 nearest = glm::clamp(centre, -box.half, box.half);
    const glm::dvec3 gap = centre - nearest;
    const double distance = std::sqrt(glm::dot(gap, gap));
    if (distance > 0.0) return sphere.half.x - distance;
    const glm::dvec3 to_faces = box.half - glm::abs(centre);
    return sphere.half.x + std::min({to_faces.x, to_faces.y, to_faces.z});
}

} // namespace

PlacedShape place(const Shape& shape, const Pose& pose) {
    PlacedShape placed;
    placed.centre = {pose.position.x, pose.position.y, pose.position.z};
    const glm::dquat rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
    placed.axes = glm::mat3_cast(glm::normalize(rotation));
    if (const Box* box = std::get_if<Box>(&shape)) {
        placed.half = 0.5 * glm::dvec3(box->size.x, box->size.y, box->size.z);
    } else {
        placed.half = glm::dvec3(std::get<Sphere>(shape).radius);
        placed.sphere = true;
    }
    return placed;
}

double penetration_depth(const PlacedShape& a, const PlacedShape& b) {
    if (a.sphere && b.sphere) return a.half.x + b.half.x - glm::distance(a.centre, b.centre);
    if (a.sphere) return sphere_and_box(a, b);
    if (b.sphere) return sphere_and_box(b, a);
    return boxes(a, b);
}

} // namespace talus::cli
