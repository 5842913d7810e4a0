// SPDX-License-Identifier: MIT
// What the built-in scenes are put together with: a static ground, static walls, boxes and spheres that can move.
#pragma once

#include <cstddef>
#include <string>

#include "scenes/scene.h"

namespace talus::scenes {

constexpr float k_steel = 7850.0f; // kg/m³

/// No bounce, 1000 kg/m³: the defaults of a body, which a scene may change in what `add_...` returns. The references
/// are valid until the next body is added.
class SceneBuilder {
public:
    /// Starts with the ground: its top is y = 0 and reaches `half_x` and `half_z` to each side of the origin. All
    /// bodies have the same friction.
    SceneBuilder(float half_x, float half_z, std::size_t expected_boxes, float friction = 0.5f);

    BodyDefinition& add_wall(const char* name, Vec3 lower, Vec3 upper);
    /// Names them "box 1", "box 2" ...
    BodyDefinition& add_box(Vec3 centre, Vec3 size = {1.0f, 1.0f, 1.0f}, Quat rotation = {});
    /// Names them "sphere 1", "sphere 2" ...
    BodyDefinition& add_sphere(Vec3 centre, float radius);

    /// Escaped is what sinks half a metre into the ground, leaves it sideways, or flies 50 m above the highest box.
    Bounds bounds() const;
    Scene finish(const Bounds&, const Camera&);

private:
    BodyDefinition& add(std::string name, const BodyDefinition&);

    Scene scene;
    Vec3 half_ground;
    float common_friction;
    float highest = 0.0f;
    std::size_t box_count = 0;
    std::size_t sphere_count = 0;
};

} // namespace talus::scenes
