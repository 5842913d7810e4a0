// SPDX-License-Identifier: MIT
// The corners of a polygon on the CPU; polygon.glsl is the counterpart of the kernels.
#pragma once

#include "state/dialect.h"

namespace talus::engine {

constexpr uint k_polygon_corners = 8;

/// Where it is, and the label of the edge that begins there.
struct alignas(16) Corner {
    vec3 position;
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

/// `i` is the same for all polygons that are treated side by side; with corner_at() it may be another for each.
inline Corner corner_of(const Polygon& polygon, uint i) {
    return polygon.corners[i];
}
inline Corner corner_at(const Polygon& polygon, uint i) {
    return polygon.corners[i];
}

/// The one behind corner i.
inline Corner corner_after(const Polygon& polygon, uint i) {
    return polygon.corners[i + 1 < polygon.count ? i + 1 : 0];
}

/// What does not fit is left out: rounding may ask for a ninth. That it is wanted holds here.
inline void add_corner(Polygon& polygon, bool /*is_wanted*/, vec3 corner, uint label) {
    if (polygon.count == k_polygon_corners) return;
    polygon.corners[polygon.count++] = {corner, label};
}

} // namespace talus::engine
