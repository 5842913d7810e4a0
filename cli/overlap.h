// SPDX-License-Identifier: MIT
// The exact overlap of two shapes, in double precision: the yardstick for max_penetration. It shares nothing with the
// narrow phase, so that a fault there cannot hide itself.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <talus/types.h>

namespace talus::cli {

/// A shape where it is. `half` holds half the edge lengths of a box; a sphere has its radius in all three.
struct PlacedShape {
    glm::dvec3 centre{0.0};
    glm::dmat3 axes{1.0}; ///< columns: the body's axes in world space
    glm::dvec3 half{0.0};
    bool sphere = false;
};

PlacedShape place(const Shape&, const Pose&);

/// The shortest way (m) that one shape must move to stop overlapping the other; 0 or less where they do not overlap.
double penetration_depth(const PlacedShape&, const PlacedShape&);

} // namespace talus::cli
