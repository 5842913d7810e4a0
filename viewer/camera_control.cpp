// SPDX-License-Identifier: MIT
#include "viewer/camera_control.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace talus::viewer {

namespace {

constexpr float k_turn = 3.0f;                          // rad for a movement over the window's height
constexpr float k_steepest = 1.55f;                     // rad; straight up, left and right would have no meaning
constexpr float k_zoom = 0.88f;                         // a notch of the wheel leaves this part of the distance
constexpr float k_fly_speed = 0.8f;                     // reaches a second
constexpr float k_nearest = 0.01f, k_farthest = 1.0e5f; // m

} // namespace

void CameraControl::look_through(const scenes::Camera& camera, float aspect) {
    target = {camera.target.x, camera.target.y, camera.target.z};
    const glm::vec3 way = target - glm::vec3(camera.eye.x, camera.eye.y, camera.eye.z);
    const glm::vec3 direction = glm::normalize(way);
    const float back = std::max(1.0f, 16.0f / 9.0f / aspect);
    distance = std::clamp(back * glm::length(way), k_nearest, k_farthest);
    pitch = std::asin(std::clamp(direction.y, -1.0f, 1.0f));
    pitch = std::clamp(pitch, -k_steepest, k_steepest);
    yaw = std::atan2(direction.x, -direction.z);
    vertical_fov = camera.vertical_fov;
}

scenes::Camera CameraControl::camera() const {
    const glm::vec3 from = eye();
    return {{from.x, from.y, from.z}, {target.x, target.y, target.z}, vertical_fov};
}

glm::vec3 CameraControl::forward() const {
    return {std::cos(pitch) * std::sin(yaw), std::sin(pitch), -std::cos(pitch) * std::cos(yaw)};
}

glm::vec3 CameraControl::right() const {
    return {std::cos(yaw), 0.0f, std::sin(yaw)};
}

glm::vec3 CameraControl::eye() const {
    return target - distance * forward();
}

void CameraControl::turn(glm::vec2 movement) {
    const glm::vec3 from = eye();
    const float rate = mode == CameraMode::Orbit ? k_turn : 0.5f * k_turn;
    yaw += rate * movement.x;
    pitch = std::clamp(pitch - rate * movement.y, -k_steepest, k_steepest);
    if (mode == CameraMode::Fly) target = from + distance * forward();
}

void CameraControl::pan(glm::vec2 movement) {
    const float height = 2.0f * distance * std::tan(0.5f * vertical_fov); // of the window, at the target
    const glm::vec3 up = glm::cross(right(), forward());
    target += height * (-movement.x * right() + movement.y * up);
}

void CameraControl::zoom(float notches) {
    if (mode == CameraMode::Fly)
        target += 0.1f * distance * notches * forward();
    else
        distance = std::clamp(distance * std::pow(k_zoom, notches), k_nearest, k_farthest);
}

void CameraControl::fly(glm::vec3 direction, float seconds) {
    const glm::vec3 world = direction.x * right() + glm::vec3(0.0f, direction.y, 0.0f) + direction.z * forward();
    target += k_fly_speed * distance * seconds * world;
}

void CameraControl::set_target(glm::vec3 wanted) {
    const glm::vec3 way = wanted - eye();
    const float length = glm::length(way);
    if (length < k_nearest) return;
    distance = length;
    target = wanted;
    pitch = std::clamp(std::asin(std::clamp(way.y / length, -1.0f, 1.0f)), -k_steepest, k_steepest);
    yaw = std::atan2(way.x, -way.z);
}

glm::vec3 CameraControl::ray_through(glm::vec2 place, float aspect) const {
    const float tangent = std::tan(0.5f * vertical_fov);
    const glm::vec3 up = glm::cross(right(), forward());
    return glm::normalize(forward() + tangent * (aspect * place.x * right() + place.y * up));
}

} // namespace talus::viewer
