// SPDX-License-Identifier: MIT
// Overlays of a world's last step: lines, and colours for bodies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include <talus/world.h>

#include "render/overlays.h"

namespace talus::render {

/// As line.vert.glsl reads it.
struct Line {
    glm::vec3 from{0.0f}; ///< m, world
    std::uint32_t colour = 0xffffffffu;
    glm::vec3 to{0.0f};
    float width = 1.5f; ///< pixels of a usual screen
};
static_assert(sizeof(Line) == 32);

/// Red in the low byte, then green, blue and opacity; linear colours from 0 to 1.
std::uint32_t pack_colour(glm::vec3, float opacity = 1.0f);
/// Different for different numbers, and far apart for neighbouring ones.
glm::vec3 colour_of_number(std::uint32_t);

/// Normals, impulses and colours of the constraint graph. `typical_size`: edge length of the usual body (m).
void add_contact_lines(std::vector<Line>&, const World&, std::span<const Contact>, const Overlays&, float typical_size);
void add_velocity_lines(std::vector<Line>&, const World&, float typical_size);
/// From a place to another, with a head.
void add_arrow(std::vector<Line>&, glm::vec3 from, glm::vec3 to, std::uint32_t colour);

/// A colour for each body slot, 0 where a body keeps its own: rigid and kinematic bodies in a pair red, islands of more
/// than one body each in a colour, what sleeps in grey.
std::vector<std::uint32_t> tints_of(const World&, std::span<const Contact>, const Overlays&, std::uint32_t slot_count);

} // namespace talus::render
