// SPDX-License-Identifier: MIT
// What the user does to bodies: holds one by a spring, drives a kinematic one, throws in new ones.
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include <talus/world.h>

#include "viewer/pick.h"

namespace talus::viewer {

/// Where a body is held, and where it is pulled to.
struct Grip {
    BodyId body;
    glm::vec3 point{0.0f};  ///< m, body axes
    glm::vec3 target{0.0f}; ///< m, world
};

/// Of bodies that are thrown in.
struct Projectile {
    float size = 1.0f;       ///< m: a ball's diameter, a box's edge
    float speed = 20.0f;     ///< m/s, of a ball
    float density = 2000.0f; ///< kg/m³
};

class Hand {
public:
    /// Takes hold of a rigid body where the ray met it.
    void hold(const World&, const Hit&);
    void release() noexcept { grip.reset(); }
    bool is_holding() const noexcept { return grip.has_value(); }
    /// Where the mouse pulls the held point to (m, world).
    void pull_to(glm::vec3 target);
    /// The held point and where it is pulled to, for drawing; nothing where nothing is held.
    std::optional<std::pair<glm::vec3, glm::vec3>> pull(const World&) const;

    /// The force of the spring for the next step. Returns whether there is one.
    bool apply(World&);

private:
    std::optional<Grip> grip;
};

/// A ball that leaves the ray's origin along the ray.
BodyDefinition ball_along(const Ray&, const Projectile&);
/// A box above a place, not yet moving.
BodyDefinition box_above(glm::vec3 place, const Projectile&);

/// The first kinematic body; nothing where there is none.
std::optional<BodyId> find_kinematic(const World&);
/// A platform, driven by the keys.
BodyDefinition platform_at(glm::vec3 place, float size);

} // namespace talus::viewer
