// SPDX-License-Identifier: MIT
// The corners of a polygon on the CPU; polygon.glsl is the counterpart of the kernels.
#pragma once

#include "state/dialect.h"

namespace talus::engine {

constexpr uint k_polygon_corners = 8;

/// Where it is, and the label of the edge that begins there.
struct alignas(16) Corner {
    vec3 place;
    uint label;
};

struct Polygon {
    Corner corners[k_polygon_corners];
    uint count; ///< corners, at most k_polygon_corners
};

inline Polygon empty_polygon() {
    Polygon polygon;
    polygon.count = 0;
    return polygon;
}

inline Polygon polygon_beside(const Polygon&) {
    return empty_polygon();
}

inline vec3 corner_of(const Polygon& polygon, uint i) {
    return polygon.corners[i].place;
}

inline uint label_of(const Polygon& polygon, uint i) {
    return polygon.corners[i].label;
}

/// What does not fit is left out: rounding may ask for a ninth.
inline void add_corner(Polygon& polygon, vec3 corner, uint label) {
    if (polygon.count == k_polygon_corners) return;
    polygon.corners[polygon.count++] = {corner, label};
}

} // namespace talus::engine
