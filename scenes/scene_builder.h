// SPDX-License-Identifier: MIT
// What the built-in scenes are put together with: a static ground, static walls and boxes that can move.
#pragma once

#include <cstddef>

#include "scenes/scene.h"

namespace talus::scenes {

/// Friction 0.5, no bounce, 1000 kg/m³: the defaults of a body.
class SceneBuilder {
public:
    /// Starts with the ground: its top is y = 0 and reaches `half_x` and `half_z` to each side of the origin.
    SceneBuilder(float half_x, float half_z, std::size_t expected_boxes);

    void add_wall(const char* name, Vec3 lower, Vec3 upper);
    /// Names them "box 1", "box 2" ...
    void add_box(Vec3 centre, Vec3 size = {1.0f, 1.0f, 1.0f}, Quat rotation = {});

    /// Escaped is what sinks half a metre into the ground, leaves it sideways, or flies 50 m above the highest box.
    Bounds bounds() const;
    Scene finish(const Bounds&, const Camera&);

private:
    Scene scene;
    Vec3 half_ground;
    float highest = 0.0f;
    std::size_t box_count = 0;
};

} // namespace talus::scenes
