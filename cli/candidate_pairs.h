// SPDX-License-Identifier: MIT
// Which boxes of a large set overlap, by a tree: the search behind the quality figures. It is independent of the broad
// phase, and does not mind a few very large boxes among many small ones.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec3.hpp>

namespace talus::cli {

/// Axis-aligned, in metres.
struct Region {
    glm::dvec3 lower{0.0}, upper{0.0};
};

/// Calls `visit` once for each two regions that overlap or touch, with the lower index first.
void for_each_overlap(std::span<const Region>, const std::function<void(std::uint32_t, std::uint32_t)>& visit);

} // namespace talus::cli
