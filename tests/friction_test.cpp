// SPDX-License-Identifier: MIT
// Coulomb's friction, on every device: what slides stops where it should and alike in every direction, what holds does
// not creep, what slides on a slope gains speed as it should, what spins stops, what rolls rolls.
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

constexpr float k_degree = std::numbers::pi_v<float> / 180.0f;
constexpr Vec3 k_up{0.0f, 1.0f, 0.0f};

class Friction : public OnDevice {};
class LongFriction : public OnDevice {};

// ---- on the level ----

/// How far a flat box slides that starts with `speed` in a direction, and is itself turned by `yaw` (m).
float stopping_distance(World& world, float friction, float speed, float direction, float yaw) {
    world.add(with_material(ground(), friction));
    BodyDefinition box = with_material(box_at({0.0f, 0.25f, 0.0f}, {2.0f, 0.5f, 2.0f}), friction);
    box.velocity.linear = {speed * std::cos(direction), 0.0f, speed * std::sin(direction)};
    box.pose.rotation = turn(k_up, yaw);
    const BodyId id = world.add(box);
    world.step(120);
    const Vec3 end = world.pose(id).position;
    const float sideways = end.z * std::cos(direction) - end.x * std::sin(direction);
    EXPECT_NEAR(sideways, 0.0f, 0.01f) << "it slides straight";
    EXPECT_LT(length(world.velocity(id).linear), 1e-3f) << "it has stopped";
    return end.x * std::cos(direction) + end.z * std::sin(direction);
}

TEST_P(Friction, a_sliding_box_stops_at_the_same_distance_in_every_direction) {
    constexpr float k_speed = 4.0f, k_friction = 0.4f;
    // v² / (2 mu g) = 2.04 m. Semi-implicit Euler brakes first and then moves: it stops v h / 2 earlier.
    const float expected = k_speed * k_speed / (2.0f * k_friction * k_gravity) - 0.5f * k_speed * substep_of();
    for (const float degrees : {0.0f, 15.0f, 30.0f, 45.0f, 60.0f, 90.0f}) {
        for (const float yaw : {0.0f, 20.0f, 45.0f}) {
            SCOPED_TRACE(std::to_string(degrees) + " degrees, box turned by " + std::to_string(yaw));
            World world = make_world();
            const float distance = stopping_distance(world, k_friction, k_speed, degrees * k_degree, yaw * k_degree);
            EXPECT_NEAR(distance, expected, 0.01f * expected);
        }
    }
}

TEST_P(Friction, of_two_materials_is_their_average) {
    World world = make_world();
    world.add(with_material(ground(), 0.5f));
    BodyDefinition box = with_material(box_at({0.0f, 0.25f, 0.0f}, {2.0f, 0.5f, 2.0f}), 0.3f);
    box.velocity.linear = {4.0f, 0.0f, 0.0f};
    const BodyId id = world.add(box);
    world.step(120);
    const float expected = 16.0f / (2.0f * 0.4f * k_gravity) - 2.0f * substep_of();
    EXPECT_NEAR(world.pose(id).position.x, expected, 0.01f * expected);
}

TEST_P(Friction, without_it_a_box_slides_on_for_ever) {
    World world = make_world();
    world.add(with_material(ground(), 0.0f));
    BodyDefinition box = with_material(box_at({0.0f, 0.5f, 0.0f}), 0.0f);
    box.velocity.linear = {4.0f, 0.0f, 0.0f};
    const BodyId id = world.add(box);
    world.step(120);
    EXPECT_NEAR(world.velocity(id).linear.x, 4.0f, 1e-4f);
    EXPECT_NEAR(world.pose(id).position.x, 8.0f, 1e-3f);
}

TEST_P(Friction, a_spinning_box_stops_where_it_is) {
    World world = make_world();
    world.add(with_material(ground(), 0.5f));
    BodyDefinition box = with_material(box_at({0.0f, 0.5f, 0.0f}), 0.5f);
    box.velocity.angular = {0.0f, 10.0f, 0.0f};
    const BodyId id = world.add(box);
    // Its weight stands on its corners, at r = a / sqrt(2): the torque is mu m g r, the moment of inertia m a² / 6.
    const float deceleration = 0.5f * k_gravity * std::numbers::sqrt2_v<float> / 2.0f * 6.0f;
    world.step(15);
    EXPECT_NEAR(world.velocity(id).angular.y, 10.0f - 0.25f * deceleration, 0.01f * 10.0f);
    world.step(60);
    EXPECT_LT(length(world.velocity(id).angular), 1e-3f);
    EXPECT_LT(length(world.velocity(id).linear), 1e-3f);
    EXPECT_LT(length(world.pose(id).position - Vec3{0.0f, 0.5f, 0.0f}), 2e-3f);
}

TEST_P(Friction, a_sphere_that_slides_at_first_rolls_at_five_sevenths) {
    for (const float direction : {0.0f, 30.0f * k_degree, 45.0f * k_degree}) {
        SCOPED_TRACE(direction);
        World world = make_world();
        world.add(with_material(ground(), 0.8f));
        BodyDefinition ball = with_material(sphere_at({0.0f, 0.5f, 0.0f}), 0.8f);
        const Vec3 ahead{std::cos(direction), 0.0f, std::sin(direction)};
        ball.velocity.linear = ahead * 3.5f;
        const BodyId id = world.add(ball);
        world.step(120);
        // Angular momentum about the ground is kept; then the contact's speed is zero: v = w r.
        const Velocity end = world.velocity(id);
        EXPECT_LT(length(end.linear - ahead * 2.5f), 0.02f);
        EXPECT_LT(length(end.angular - Vec3{ahead.z, 0.0f, -ahead.x} * 5.0f), 0.01f * 5.0f);
        EXPECT_NEAR(world.pose(id).position.y, 0.5f, 2e-3f);
    }
}

TEST_P(Friction, a_rolling_sphere_rolls_on) {
    World world = make_world();
    world.add(with_material(ground(), 0.8f));
    BodyDefinition ball = with_material(sphere_at({0.0f, 0.5f, 0.0f}), 0.8f);
    ball.velocity = {{2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -4.0f}};
    const BodyId id = world.add(ball);
    world.step(300);
    EXPECT_NEAR(world.velocity(id).linear.x, 2.0f, 0.01f * 2.0f);
    EXPECT_NEAR(world.pose(id).position.x, 10.0f, 0.01f * 10.0f);
}

// ---- on a slope ----

/// A box, or a sphere, on a slope that falls towards +x.
struct Slope {
    Vec3 normal, downhill, start;
    BodyId body;

    Slope(World& world, float angle, float friction, BodyDefinition load, float half_height, float yaw = 0.0f)
        : normal{std::sin(angle), std::cos(angle), 0.0f}, downhill{std::cos(angle), -std::sin(angle), 0.0f} {
        const Quat tilt = turn({0.0f, 0.0f, 1.0f}, -angle);
        BodyDefinition plane = with_material(box_at({}, {200.0f, 1.0f, 10.0f}, BodyKind::Static), friction);
        plane.pose.rotation = tilt;
        world.add(plane);
        start = normal * (0.5f + half_height);
        load.pose.position = start;
        const glm::dquat turned = exact(tilt) * exact(turn(k_up, yaw));
        load.pose.rotation = {static_cast<float>(turned.x), static_cast<float>(turned.y), static_cast<float>(turned.z),
                              static_cast<float>(turned.w)};
        load.material.friction = friction;
        body = world.add(load);
    }

    float along(Vec3 v) const { return v.x * downhill.x + v.y * downhill.y; }
};

TEST_P(Friction, a_box_slides_down_a_slope_with_what_gravity_has_left) {
    constexpr float k_friction = 0.5f; // holds up to 26.6 degrees
    for (const float degrees : {28.0f, 35.0f, 45.0f}) {
        for (const float yaw : {0.0f, 30.0f}) {
            SCOPED_TRACE(std::to_string(degrees) + " degrees, box turned by " + std::to_string(yaw));
            World world = make_world();
            const Slope slope(world, degrees * k_degree, k_friction, box_at({}, {1.0f, 0.5f, 1.0f}), 0.25f,
                              yaw * k_degree);
            world.step(30);
            const float speed = slope.along(world.velocity(slope.body).linear);
            world.step(60);
            const float gained = slope.along(world.velocity(slope.body).linear) - speed; // in a second
            const float expected =
                k_gravity * (std::sin(degrees * k_degree) - k_friction * std::cos(degrees * k_degree));
            EXPECT_NEAR(gained, expected, 0.01f * expected);
            EXPECT_NEAR(world.pose(slope.body).position.z, 0.0f, 1e-3f) << "straight down";
            EXPECT_NEAR(world.velocity(slope.body).linear.z, 0.0f, 1e-3f);
        }
    }
}

TEST_P(Friction, a_slope_below_the_angle_of_friction_holds) {
    for (const float degrees : {20.0f, 25.0f}) {
        SCOPED_TRACE(degrees);
        World world = make_world();
        const Slope slope(world, degrees * k_degree, 0.5f, box_at({}, {1.0f, 0.5f, 1.0f}), 0.25f);
        world.step(90);
        EXPECT_LT(length(world.pose(slope.body).position - slope.start), 1e-3f);
    }
}

TEST_P(LongFriction, a_box_on_a_slope_does_not_creep) {
    constexpr float k_friction = 0.5f;
    const float angle = 0.9f * std::atan(k_friction);
    for (const float yaw : {0.0f, 30.0f, 45.0f}) {
        SCOPED_TRACE(yaw);
        World world = make_world();
        const Slope slope(world, angle, k_friction, box_at({}, {1.0f, 0.5f, 1.0f}), 0.25f, yaw * k_degree);
        world.step(3600);
        EXPECT_LT(length(world.pose(slope.body).position - slope.start), 1e-3f) << "a millimetre in a minute";
    }
}

TEST_P(Friction, a_sphere_rolls_down_a_slope_with_five_sevenths_of_gravity) {
    constexpr float k_angle = 20.0f * k_degree;
    World world = make_world();
    const Slope slope(world, k_angle, 0.5f, sphere_at({}), 0.5f); // rolls up to tan = 3.5 mu
    world.step(30);
    const float speed = slope.along(world.velocity(slope.body).linear);
    world.step(60);
    const float expected = 5.0f / 7.0f * k_gravity * std::sin(k_angle);
    EXPECT_NEAR(slope.along(world.velocity(slope.body).linear) - speed, expected, 0.01f * expected);
    EXPECT_NEAR(world.velocity(slope.body).angular.z, -slope.along(world.velocity(slope.body).linear) / 0.5f, 0.05f);
}

TALUS_ON_EVERY_DEVICE(Friction);
TALUS_ON_THE_CPU(LongFriction);

} // namespace
} // namespace talus::tests
