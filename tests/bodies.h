// SPDX-License-Identifier: MIT
// Bodies that many tests need, and arithmetic on the public vectors.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include <talus/talus.h>

#include "scenes/scene.h"

namespace talus::tests {

inline Vec3 operator+(Vec3 a, Vec3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(Vec3 a, Vec3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator*(Vec3 a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}
inline float length(Vec3 v) {
    return std::hypot(v.x, v.y, v.z);
}
inline bool is_finite(Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline Settings weightless() {
    Settings settings;
    settings.gravity = {};
    return settings;
}

/// A turn by `angle` (rad) about a unit axis.
inline Quat turn(Vec3 axis, float angle) {
    const Vec3 u = axis * std::sin(0.5f * angle);
    return {u.x, u.y, u.z, std::cos(0.5f * angle)};
}

inline BodyDefinition box_at(Vec3 position, Vec3 size = {1.0f, 1.0f, 1.0f}, BodyKind kind = BodyKind::Rigid) {
    BodyDefinition definition;
    definition.kind = kind;
    definition.shape = Box{size};
    definition.pose.position = position;
    return definition;
}

inline BodyDefinition sphere_at(Vec3 position, float radius = 0.5f) {
    BodyDefinition definition;
    definition.shape = Sphere{radius};
    definition.pose.position = position;
    return definition;
}

/// A wide static box with its upper side at y = 0.
inline BodyDefinition ground() {
    return box_at({0.0f, -1.0f, 0.0f}, {100.0f, 2.0f, 100.0f}, BodyKind::Static);
}

inline BodyDefinition with_material(BodyDefinition definition, float friction, float restitution = 0.0f) {
    definition.material = {friction, restitution, Combine::Average, Combine::Average};
    return definition;
}

inline BodyDefinition weighing(BodyDefinition definition, float mass) {
    definition.mass = mass;
    return definition;
}

/// Boxes of 1 t that fall together from 10 cm: one in the middle, four at its sides, and one of `mass` (kg) on it.
inline std::vector<BodyDefinition> crowded_box(float x, float mass) {
    constexpr float height = 0.6f;
    std::vector<BodyDefinition> bodies{box_at({x, height, 0.0f})};
    for (const Vec3 side : {Vec3{1.0f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, -1.0f}})
        bodies.push_back(box_at(Vec3{x, height, 0.0f} + side));
    bodies.push_back(weighing(box_at({x + 0.05f, height + 1.0f, 0.03f}), mass));
    return bodies;
}

inline std::vector<BodyDefinition> bodies_of(std::string_view scene_name) {
    std::vector<BodyDefinition> definitions;
    for (const scenes::NamedBody& body : scenes::make_scene(scene_name).bodies)
        definitions.push_back(body.definition);
    return definitions;
}

inline std::vector<BodyDefinition> with_restitution(std::vector<BodyDefinition> bodies, float restitution) {
    for (BodyDefinition& body : bodies)
        body.material.restitution = restitution;
    return bodies;
}

/// A plate that lies on the ground and carries side × side boxes: with_hubs it is a hub from side = 6 on, and it has
/// more contacts than there are colours from side = 8 on.
inline std::vector<BodyDefinition> plate_of(std::uint32_t side) {
    const float width = 1.25f * static_cast<float>(side);
    std::vector<BodyDefinition> bodies{ground(), box_at({0.0f, 0.25f, 0.0f}, {width, 0.5f, width})};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const float x = 1.25f * (static_cast<float>(i % side) + 0.5f) - 0.5f * width;
        const float z = 1.25f * (static_cast<float>(i / side) + 0.5f) - 0.5f * width;
        bodies.push_back(box_at({x, 1.0f, z}));
    }
    return bodies;
}

/// Settings by which a plate with some boxes is a hub.
inline Settings with_hubs(Settings settings = {}) {
    settings.hub_contacts = 32;
    return settings;
}

/// Small boxes, on them a plate, on that a second one, and small boxes again: side × side in each layer. The plates
/// touch each other and with_hubs are hubs both from side = 6 on.
inline std::vector<BodyDefinition> two_plates(std::uint32_t side) {
    const float width = 1.25f * static_cast<float>(side);
    std::vector<BodyDefinition> bodies{ground(), box_at({0.0f, 0.75f, 0.0f}, {width, 0.5f, width}),
                                       box_at({0.0f, 1.25f, 0.0f}, {width, 0.5f, width})};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const float x = 1.25f * (static_cast<float>(i % side) + 0.5f) - 0.5f * width;
        const float z = 1.25f * (static_cast<float>(i / side) + 0.5f) - 0.5f * width;
        for (const float y : {0.25f, 1.75f})
            bodies.push_back(box_at({x, y, z}, {0.5f, 0.5f, 0.5f}));
    }
    return bodies;
}

/// A table that lies loose on legs, `legs` × `legs` of them as wide as `leg` (m), with side × side boxes of 0.5 m on
/// it. Bodies 1 is its top, the legs follow, and then the boxes. The top of side = 8 has 7 t and is a hub with_hubs.
inline std::vector<BodyDefinition> table_on_legs(std::uint32_t side, std::uint32_t legs, float leg = 0.4f) {
    constexpr float k_pitch = 0.66f, k_top = 0.25f;
    const float width = k_pitch * static_cast<float>(side);
    const auto place = [](std::uint32_t i, std::uint32_t count, float pitch) {
        return pitch * (static_cast<float>(i) - 0.5f * static_cast<float>(count - 1));
    };
    std::vector<BodyDefinition> bodies{ground(), box_at({0.0f, 1.0f + 0.5f * k_top, 0.0f}, {width, k_top, width})};
    const float apart = (width - leg) / static_cast<float>(legs - 1);
    for (std::uint32_t i = 0; i < legs * legs; ++i)
        bodies.push_back(box_at({place(i % legs, legs, apart), 0.5f, place(i / legs, legs, apart)}, {leg, 1.0f, leg}));
    for (std::uint32_t i = 0; i < side * side; ++i)
        bodies.push_back(box_at({place(i % side, side, k_pitch), 1.25f + k_top, place(i / side, side, k_pitch)},
                                {0.5f, 0.5f, 0.5f}));
    return bodies;
}

/// Boxes and spheres that spin, bounce, slide and are damped, and a kinematic box that runs into them.
inline std::vector<BodyDefinition> mixed_bodies() {
    std::vector<BodyDefinition> bodies{with_material(ground(), 0.4f, 0.5f)};
    for (int i = 0; i < 40; ++i) {
        const float x = static_cast<float>(i % 5), z = 0.3f * static_cast<float>(i % 3);
        const Vec3 position{x, 1.0f + 1.1f * static_cast<float>(i / 5), z};
        BodyDefinition body = i % 3 == 0 ? sphere_at(position, 0.4f) : box_at(position, {0.9f, 0.5f, 0.7f});
        body = with_material(body, 0.1f * static_cast<float>(i % 7), 0.2f * static_cast<float>(i % 4));
        body.velocity = {{0.0f, -3.0f, 1.0f}, {1.0f, 5.0f, -2.0f}};
        body.linear_damping = 0.1f;
        bodies.push_back(body);
    }
    bodies.push_back(box_at({6.0f, 0.5f, 0.0f}, {1.0f, 1.0f, 4.0f}, BodyKind::Kinematic));
    bodies.back().velocity.linear = {-1.0f, 0.0f, 0.0f};
    return bodies;
}

} // namespace talus::tests
