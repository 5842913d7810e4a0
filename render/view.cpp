// SPDX-License-Identifier: MIT
// Builds the view. The sun stands to the left of the camera and behind it, high up, wherever the camera looks from: the
// sides that one sees are lit, and shadows fall to the right and away.
#include "render/view.h"

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace talus::render {

namespace {

glm::vec3 to_glm(const Vec3& v) {
    return {v.x, v.y, v.z};
}

/// 1, 2 or 5 times a power of ten, near `length`.
float round_length(float length) {
    const float power = std::pow(10.0f, std::floor(std::log10(length)));
    const float leading = length / power;
    return power * (leading < 1.5f ? 1.0f : leading < 3.5f ? 2.0f : leading < 7.5f ? 5.0f : 10.0f);
}

} // namespace

View make_view(const scenes::Camera& camera, std::uint32_t width, std::uint32_t height, float typical_size) {
    const glm::vec3 eye = to_glm(camera.eye), target = to_glm(camera.target);
    const float away = glm::distance(eye, target);
    if (!std::isfinite(away) || away <= 0.0f)
        throw Error("camera: eye and target must be finite and apart from each other");
    if (!(camera.vertical_fov > 0.0f && camera.vertical_fov < 3.1f))
        throw Error("camera: the vertical field of view is " + std::to_string(camera.vertical_fov) +
                    " rad; it must be more than 0 and less than 3.1");

    const glm::vec3 forward = (target - eye) / away;
    const bool vertical = std::abs(forward.y) > 0.999f;
    const glm::vec3 up = vertical ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    const glm::vec3 right = glm::normalize(glm::cross(forward, up));
    const glm::vec3 level_forward = vertical ? up : glm::normalize(glm::vec3(forward.x, 0.0f, forward.z));
    const glm::vec3 sun = glm::normalize(-0.62f * right - 0.38f * level_forward + glm::vec3(0.0f, 1.15f, 0.0f));
    const glm::vec3 light_right = glm::normalize(glm::cross(level_forward, sun));

    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    View view;
    view.view_projection =
        glm::perspective(camera.vertical_fov, aspect, 0.01f * away, 100.0f * away) * glm::lookAt(eye, target, up);
    view.eye = {eye, 2.0f * std::tan(0.5f * camera.vertical_fov) / static_cast<float>(height)};
    view.target = {target, away};
    view.light_right = {light_right, 0.0f};
    view.light_up = {glm::cross(sun, light_right), 0.0f};
    view.light_sun = {sun, 0.0f};
    view.sizes = {typical_size, round_length(away / 10.0f), 0.0f, 0.0f};
    view.viewport = {static_cast<float>(width), static_cast<float>(height), 0.0f, 0.0f};
    return view;
}

} // namespace talus::render
