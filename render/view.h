// SPDX-License-Identifier: MIT
// The camera and the light as the shaders want them.
#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/scene.h"

namespace talus::render {

/// The uniform block View of shaders/view.glsl; the meaning of each field is told there.
struct View {
    glm::mat4 view_projection;
    glm::vec4 eye, target, light_right, light_up, light_sun, sizes, viewport;
};
static_assert(sizeof(View) == 64 + 7 * 16);

/// `typical_size`: edge length of the scene's usual body (m). Throws Error for a camera that cannot see.
View make_view(const scenes::Camera&, std::uint32_t width, std::uint32_t height, float typical_size);

} // namespace talus::render
