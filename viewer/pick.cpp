// SPDX-License-Identifier: MIT
// Rays are taken into body axes, where a box is three pairs of planes (the slab test) and a sphere is a sphere.
#include "viewer/pick.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace talus::viewer {

namespace {

/// Distance at which the ray enters, and the normal there, in body axes.
using Entry = std::optional<std::pair<float, glm::vec3>>;

Entry enter_sphere(const Ray& ray, float radius) {
    const float along = glm::dot(ray.origin, ray.direction);
    const glm::vec3 nearest = ray.origin - along * ray.direction;
    const float half_squared = radius * radius - glm::dot(nearest, nearest);
    if (half_squared < 0.0f) return {};
    const float distance = -along - std::sqrt(half_squared);
    if (distance < 0.0f) return {};
    return std::pair(distance, (ray.origin + distance * ray.direction) / radius);
}

Entry enter_box(const Ray& ray, glm::vec3 half) {
    float enter = -std::numeric_limits<float>::infinity(), leave = std::numeric_limits<float>::infinity();
    glm::vec3 normal{0.0f};
    for (int axis = 0; axis < 3; ++axis) {
        const float origin = ray.origin[axis], direction = ray.direction[axis];
        if (direction == 0.0f) {
            if (std::abs(origin) > half[axis]) return {};
            continue;
        }
        const float side = direction > 0.0f ? -1.0f : 1.0f; // of the plane that the ray meets first
        const float near = (side * half[axis] - origin) / direction;
        const float far = (-side * half[axis] - origin) / direction;
        if (near > enter) {
            enter = near;
            normal = glm::vec3(0.0f);
            normal[axis] = side;
        }
        leave = std::min(leave, far);
    }
    if (enter > leave || enter < 0.0f) return {};
    return std::pair(enter, normal);
}

} // namespace

std::optional<Hit> meet(const Ray& ray, const Shape& shape, const Pose& pose) {
    const glm::quat rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
    const glm::quat back = glm::conjugate(rotation);
    const glm::vec3 centre(pose.position.x, pose.position.y, pose.position.z);
    const Ray local{back * (ray.origin - centre), back * ray.direction};
    Entry entry;
    if (const auto* box = std::get_if<Box>(&shape))
        entry = enter_box(local, 0.5f * glm::vec3(box->size.x, box->size.y, box->size.z));
    else
        entry = enter_sphere(local, std::get<Sphere>(shape).radius);
    if (!entry) return {};
    return Hit{{}, entry->first, ray.origin + entry->first * ray.direction, rotation * entry->second};
}

std::optional<Hit> pick(const World& world, const Ray& ray) {
    const std::vector<BodyId> bodies = world.bodies();
    const std::vector<Pose> poses = world.poses();
    std::optional<Hit> nearest;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (world.is_sensor(bodies[i])) continue;
        std::optional<Hit> hit = meet(ray, world.shape(bodies[i]), poses[i]);
        if (!hit || (nearest && hit->distance >= nearest->distance)) continue;
        hit->body = bodies[i];
        nearest = hit;
    }
    return nearest;
}

} // namespace talus::viewer
