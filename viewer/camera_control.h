// SPDX-License-Identifier: MIT
// The camera as the user moves it: around a point (orbit), or freely (fly).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "scenes/scene.h"

namespace talus::viewer {

enum class CameraMode { Orbit, Fly };

class CameraControl {
public:
    /// Takes over a camera's direction and, for a window of 16:9 or wider, its place; from farther away in a narrower
    /// one, which so shows as much.
    void look_through(const scenes::Camera&, float aspect = 16.0f / 9.0f);
    scenes::Camera camera() const;

    CameraMode mode = CameraMode::Orbit;

    /// Turns by a movement of the mouse, in heights of the window: around the target (orbit), or the head (fly).
    void turn(glm::vec2 movement);
    /// Moves sideways and up, so that what lies at the target's distance follows the mouse.
    void pan(glm::vec2 movement);
    /// Nearer (positive) or farther; flying: onwards or back.
    void zoom(float notches);
    /// Flies by a direction in camera axes (x right, y up, z forward) for some seconds.
    void fly(glm::vec3 direction, float seconds);
    /// Orbits around this point from now on; the eye stays where it is.
    void set_target(glm::vec3);

    /// Unit vector through a place in the window; x and y from -1 to 1, y up.
    glm::vec3 ray_through(glm::vec2 place, float aspect) const;
    glm::vec3 eye() const;
    glm::vec3 forward() const;
    /// Level, to the right.
    glm::vec3 right() const;
    /// From the eye to the target (m): the scale of movements.
    float reach() const noexcept { return distance; }

private:
    glm::vec3 target{0.0f};
    float distance = 10.0f; ///< m
    float yaw = 0.0f;       ///< rad; 0 looks along -z
    float pitch = 0.0f;     ///< rad; positive looks up
    float vertical_fov = 0.7f;
};

} // namespace talus::viewer
