// SPDX-License-Identifier: MIT
// Puts bodies into a scene and names them.
#include "scenes/scene_builder.h"

#include <algorithm>
#include <utility>

namespace talus::scenes {

namespace {

constexpr float k_ground_thickness = 10.0f; // m; no body passes through it within one step
constexpr float k_headroom = 50.0f;         // m
constexpr float k_sunk = 0.5f;              // m; a cube of 1 m is then wholly below the surface

} // namespace

SceneBuilder::SceneBuilder(float half_x, float half_z, std::size_t expected_boxes, float friction)
    : half_ground{half_x, 0.5f * k_ground_thickness, half_z}, common_friction(friction) {
    scene.bodies.reserve(expected_boxes + 5);
    add_wall("ground", {-half_x, -k_ground_thickness, -half_z}, {half_x, 0.0f, half_z});
}

BodyDefinition& SceneBuilder::add_wall(const char* name, Vec3 lower, Vec3 upper) {
    BodyDefinition definition;
    definition.kind = BodyKind::Static;
    definition.shape = Box{{upper.x - lower.x, upper.y - lower.y, upper.z - lower.z}};
    definition.pose.position = {0.5f * (lower.x + upper.x), 0.5f * (lower.y + upper.y), 0.5f * (lower.z + upper.z)};
    return add(name, definition);
}

BodyDefinition& SceneBuilder::add_box(Vec3 centre, Vec3 size, Quat rotation) {
    BodyDefinition definition;
    definition.shape = Box{size};
    definition.pose = {centre, rotation};
    highest = std::max(highest, centre.y);
    return add("box " + std::to_string(++box_count), definition);
}

BodyDefinition& SceneBuilder::add_sphere(Vec3 centre, float radius) {
    BodyDefinition definition;
    definition.shape = Sphere{radius};
    definition.pose.position = centre;
    highest = std::max(highest, centre.y);
    return add("sphere " + std::to_string(++sphere_count), definition);
}

BodyDefinition& SceneBuilder::add(std::string name, const BodyDefinition& definition) {
    scene.bodies.push_back({std::move(name), definition});
    NamedBody& body = scene.bodies.back();
    body.definition.material.friction = common_friction;
    return body.definition;
}

Bounds SceneBuilder::bounds() const {
    return {{-half_ground.x, -k_sunk, -half_ground.z}, {half_ground.x, highest + k_headroom, half_ground.z}};
}

Scene SceneBuilder::finish(const Bounds& bounds, const Camera& camera) {
    scene.bounds = bounds;
    scene.camera = camera;
    return std::move(scene);
}

} // namespace talus::scenes
