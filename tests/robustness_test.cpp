// SPDX-License-Identifier: MIT
// Bodies that go wrong, on every device: what becomes non-finite is frozen and reported, speed has its limits, and the
// fast do not pass through walls.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

class Robustness : public OnDevice {};

/// A heap of 40 boxes, of a gram to a hundred tons, that fall on each other.
std::vector<BodyDefinition> light_and_heavy(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto number = [&](float from, float to) { // the same on every standard library
        return from + (to - from) * static_cast<float>(random() % 100'000) / 100'000.0f;
    };
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < 40; ++i) {
        const float x = number(-2.0f, 2.0f), z = number(-2.0f, 2.0f);
        const float width = number(0.2f, 1.2f), height = number(0.2f, 1.2f), depth = number(0.2f, 1.2f);
        BodyDefinition box = box_at({x, 0.5f + 0.3f * static_cast<float>(i), z}, {width, height, depth});
        box.pose.rotation = turn({0.6f, 0.0f, 0.8f}, number(0.0f, 1.5f));
        box.mass = std::pow(10.0f, number(-4.0f, 5.0f));
        box.material.friction = number(0.0f, 0.6f);
        bodies.push_back(box);
    }
    return bodies;
}

TEST_P(Robustness, light_and_heavy_boxes_that_slide_past_each_other_stay_finite) {
    for (const std::uint32_t seed : {24u, 139u}) { // what slip adds to K is large there, and impulses had no end
        World world = make_world();
        world.add(light_and_heavy(seed));
        world.step(120);
        EXPECT_EQ(world.report().frozen_bodies, 0u) << "seed " << seed;
    }
}

TEST_P(Robustness, a_non_finite_body_is_frozen_and_harms_nobody) {
    World world = make_world();
    world.add(ground());
    BodyDefinition feather = box_at({0.0f, 0.5f, 0.0f});
    feather.mass = 1.0e-12f; // 10¹² N on it overflow a float
    const BodyId wild = world.add(feather);
    std::vector<BodyId> others;
    for (const Vec3 position : {Vec3{1.01f, 0.5f, 0.0f}, Vec3{0.0f, 1.5f, 0.0f}, Vec3{-1.01f, 0.5f, 0.2f}})
        others.push_back(world.add(box_at(position)));
    world.step(5);
    EXPECT_EQ(world.report().frozen_bodies, 0u);
    for (int i = 0; i < 3; ++i) {
        world.add_force(wild, {1.0e12f, 0.0f, 1.0e12f});
        world.step();
    }
    EXPECT_EQ(world.report().frozen_bodies, 1u);
    EXPECT_TRUE(is_finite(world.pose(wild).position));
    EXPECT_EQ(world.velocity(wild), Velocity{});
    const Pose frozen = world.pose(wild);
    world.step(60);
    EXPECT_EQ(world.pose(wild), frozen) << "it stays where it is";
    for (const BodyId id : others) {
        EXPECT_TRUE(is_finite(world.pose(id).position) && is_finite(world.velocity(id).linear));
        EXPECT_LT(length(world.velocity(id).linear), 1.0f) << id.index;
        EXPECT_LT(length(world.pose(id).position), 3.0f) << id.index;
    }
    // It thaws where the caller says where it is, or how it moves.
    world.set_pose(wild, {{20.0f, 5.0f, 0.0f}, {}});
    world.step(30);
    EXPECT_LT(world.pose(wild).position.y, 4.5f);
    EXPECT_EQ(world.report().frozen_bodies, 1u);
}

TEST_P(Robustness, a_body_without_a_place_is_frozen_and_harms_nobody) {
    // No public call lets such a pose in, so it is written behind the world's back.
    EngineRun run(options_on(GetParam()), bodies_of("stack:height=3"));
    engine::BodyPose lost = run.table.poses[2];
    lost.position.x = std::numeric_limits<float>::quiet_NaN();
    run.simulation.write(engine::BufferId::Poses, 2, std::span<const engine::BodyPose>(&lost, 1));
    run.step(15); // the box above the lost one falls through its place
    EXPECT_EQ(run.counter(engine::k_counter_frozen_bodies), 1u);
    const auto poses = run.read<engine::BodyPose>(engine::BufferId::Poses, 4);
    EXPECT_NE(poses[2].flags & engine::k_body_frozen, 0u);
    EXPECT_NEAR(poses[1].position.y, 0.5f, 2e-3f);
    EXPECT_TRUE(engine::is_finite3(poses[3].position));
}

TEST_P(Robustness, speed_is_held_to_its_limits) {
    Settings settings = weightless();
    settings.max_linear_speed = 10.0f;
    settings.max_angular_speed = 3.0f;
    World world = make_world(settings);
    const BodyId id = world.add(box_at({}));
    world.set_velocity(id, {{300.0f, 400.0f, 0.0f}, {0.0f, 0.0f, -50.0f}});
    world.step();
    EXPECT_LT(length(world.velocity(id).linear - Vec3{6.0f, 8.0f, 0.0f}), 1e-4f);
    EXPECT_LT(length(world.velocity(id).angular - Vec3{0.0f, 0.0f, -3.0f}), 1e-4f);
}

TEST_P(Robustness, what_contacts_throw_is_held_to_the_limits_of_speed) {
    for (const std::uint32_t seed : {16u, 28u}) { // boxes of a gram had 640 and 760 rad/s at the end of a step
        World world = make_world();
        const Settings limits = world.settings();
        std::vector<BodyId> ids;
        for (BodyDefinition& body : light_and_heavy(seed)) {
            if (body.kind == BodyKind::Rigid) body.velocity.linear.y = -20.0f;
            ids.push_back(world.add(body));
        }
        for (int i = 0; i < 20; ++i) {
            world.step();
            for (const BodyId id : ids) {
                EXPECT_LE(length(world.velocity(id).linear), limits.max_linear_speed * (1.0f + 1e-6f)) << i;
                EXPECT_LE(length(world.velocity(id).angular), limits.max_angular_speed * (1.0f + 1e-6f)) << i;
            }
        }
    }
}

TEST_P(Robustness, a_pusher_faster_than_the_limit_does_not_take_bodies_beyond_it) {
    Settings settings = weightless();
    settings.max_linear_speed = 5.0f;
    World world = make_world(settings);
    BodyDefinition pusher = box_at({-1.5f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}, BodyKind::Kinematic);
    pusher.velocity.linear = {20.0f, 0.0f, 0.0f};
    const BodyId pushing = world.add(pusher);
    const BodyId pushed = world.add(box_at({}));
    float fastest = 0.0f;
    for (int i = 0; i < 12; ++i) {
        world.step();
        fastest = std::max(fastest, length(world.velocity(pushed).linear));
        EXPECT_LE(fastest, 5.0f * (1.0f + 1e-6f)) << i;
        EXPECT_LE(world.pose(pushed).position.x, 5.0f * static_cast<float>(i + 1) / 60.0f + 1e-5f) << i;
    }
    EXPECT_GT(fastest, 5.0f * (1.0f - 1e-6f));
    EXPECT_NEAR(world.pose(pushing).position.x, -1.5f + 4.0f, 1e-4f) << "it is its caller's and has no limit";
}

/// A hit is not among the impulses that the next sub-step starts from, and nor may be what the limit takes from it.
TEST_P(Robustness, what_is_hit_beyond_the_limit_goes_on_at_it) {
    Settings settings = weightless();
    settings.max_linear_speed = 10.0f;
    World world = make_world(settings);
    const BodyId heavy = world.add(weighing(with_material(sphere_at({-1.1f, 0.0f, 0.0f}), 0.0f, 1.0f), 100.0f));
    const BodyId light = world.add(weighing(with_material(sphere_at({}), 0.0f, 1.0f), 1.0f));
    world.set_velocity(heavy, {{8.0f, 0.0f, 0.0f}, {}}); // the light one leaves with 15.8 m/s
    for (int i = 0; i < 30; ++i)
        world.step();
    EXPECT_NEAR(world.velocity(light).linear.x, 10.0f, 1e-4f);
}

TEST_P(Robustness, fast_bodies_do_not_pass_through_walls) {
    World world = make_world(weightless());
    world.add(box_at({0.0f, 0.0f, 0.0f}, {0.1f, 10.0f, 10.0f}, BodyKind::Static));
    const BodyId bullet = world.add(sphere_at({-5.0f, 0.0f, 0.0f}, 0.05f));
    world.set_velocity(bullet, {{400.0f, 0.0f, 0.0f}, {}}); // 6.7 m a step
    world.step(10);
    EXPECT_LT(world.pose(bullet).position.x, 0.0f);
}

TALUS_ON_EVERY_DEVICE(Robustness);

} // namespace
} // namespace talus::tests
