// SPDX-License-Identifier: MIT
// Built-in scenes in motion, on the CPU: a row of dominoes falls one by one, a house of cards stands, boxes on a slope
// stay or slide by the friction's law.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/scene.h"
#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::scenes {
namespace {

using tests::operator-;
using tests::length;

/// A scene on the CPU, and where its moving bodies, which are all boxes, began.
class SceneRun {
public:
    explicit SceneRun(const std::string& specification)
        : scene(make_scene(specification)), world(scene.settings, tests::options_on(DeviceKind::Cpu)) {
        for (const NamedBody& body : scene.bodies) {
            const BodyId id = world.add(body.definition);
            if (body.definition.kind != BodyKind::Rigid) continue;
            boxes.push_back(id);
            starts.push_back(body.definition.pose);
        }
    }

    Scene scene;
    World world;
    std::vector<BodyId> boxes;
    std::vector<Pose> starts;
};

/// The y component of the body's y axis: the cosine of its angle to the vertical.
float uprightness(const Pose& pose) {
    const Quat& q = pose.rotation;
    return 1.0f - 2.0f * (q.x * q.x + q.z * q.z);
}

/// Radians from one rotation to the other. By the chord and not by the dot product, whose arc cosine is coarse near 1.
float angle_between(Quat a, Quat b) {
    const float sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0.0f ? -1.0f : 1.0f;
    const float x = a.x - sign * b.x, y = a.y - sign * b.y, z = a.z - sign * b.z, w = a.w - sign * b.w;
    return 4.0f * std::asin(std::min(1.0f, 0.5f * std::sqrt(x * x + y * y + z * z + w * w)));
}

TEST(scenes_run, all_dominoes_fall_one_after_the_other) {
    for (const char* specification : {"dominoes:bend=0", "dominoes", "dominoes:count=20,bend=60"}) {
        SCOPED_TRACE(specification);
        SceneRun run(specification);
        // Beyond atan(0.15) = 8.5° a domino falls by itself; before 30° it has met the next one.
        const float tipped = std::cos(std::numbers::pi_v<float> / 6.0f);
        constexpr std::uint32_t k_never = 0, k_limit = 1800;
        std::vector<std::uint32_t> tipped_at(run.boxes.size(), k_never);
        for (std::uint32_t step = 1; step <= k_limit; ++step) {
            run.world.step();
            for (std::size_t i = 0; i < run.boxes.size(); ++i)
                if (tipped_at[i] == k_never && uprightness(run.world.pose(run.boxes[i])) < tipped) tipped_at[i] = step;
        }
        EXPECT_NE(tipped_at.front(), k_never) << "the first domino stands";
        for (std::size_t i = 1; i < tipped_at.size(); ++i) {
            EXPECT_NE(tipped_at[i], k_never) << "domino " << i + 1 << " stands";
            EXPECT_GT(tipped_at[i], tipped_at[i - 1]) << "domino " << i + 1 << " was not pushed by the one before it";
        }
        // Fallen dominoes lie on the next ones, as flat as a thickness for each pitch: by asin(0.15 / 0.5) = 17.5°
        // above the ground. The last ones have fewer to lie on.
        for (std::size_t i = 0; i < run.boxes.size(); ++i)
            EXPECT_LT(uprightness(run.world.pose(run.boxes[i])), 0.4f) << "domino " << i + 1;
    }
}

TEST(scenes_run, dominoes_stand_until_they_are_pushed) {
    SceneRun run("dominoes:count=40");
    run.world.set_velocity(run.boxes.front(), {});
    run.world.step(600);
    for (std::size_t i = 0; i < run.boxes.size(); ++i)
        EXPECT_LT(length(run.world.pose(run.boxes[i]).position - run.starts[i].position), 1e-3f) << "domino " << i + 1;
}

TEST(scenes_run, a_house_of_cards_stands) {
    // It settles by the softness of its contacts: down, hardly sideways. A card that slips or tips goes much farther.
    constexpr float k_sunk = 0.05f, k_aside = 0.01f, k_turned = 0.05f, k_speed = 1e-3f; // m, m, rad, m/s
    SceneRun run("card_house");
    run.world.step(1200);
    for (std::size_t i = 0; i < run.boxes.size(); ++i) {
        SCOPED_TRACE("card " + std::to_string(i + 1));
        const Pose pose = run.world.pose(run.boxes[i]);
        const Vec3 moved = pose.position - run.starts[i].position;
        EXPECT_LT(std::abs(moved.y), k_sunk);
        EXPECT_LT(std::hypot(moved.x, moved.z), k_aside);
        EXPECT_LT(angle_between(pose.rotation, run.starts[i].rotation), k_turned);
        EXPECT_LT(length(run.world.velocity(run.boxes[i]).linear), k_speed);
    }
}

TEST(scenes_run, a_house_of_slippery_cards_falls) {
    // It is friction that holds the house of the test above: its feet need tan a = 0.29.
    Scene scene = make_scene("card_house");
    World world(scene.settings, tests::options_on(DeviceKind::Cpu));
    std::vector<BodyId> ids;
    for (NamedBody& body : scene.bodies) {
        body.definition.material.friction = 0.1f;
        ids.push_back(world.add(body.definition));
    }
    world.step(300);
    float highest = 0.0f;
    for (const BodyId id : ids)
        highest = std::max(highest, world.pose(id).position.y);
    EXPECT_LT(highest, 2.0f) << "of 4.9 m";
}

TEST(scenes_run, boxes_on_a_slope_stay_below_the_angle_of_friction) {
    // tan 26° = 0.488. Soft contacts give way once, by less than a millimetre.
    SceneRun run("slope:angle=26,friction=0.5");
    run.world.step(60);
    std::vector<Vec3> settled;
    for (const BodyId box : run.boxes)
        settled.push_back(run.world.pose(box).position);
    run.world.step(540);
    for (std::size_t i = 0; i < run.boxes.size(); ++i)
        EXPECT_LT(length(run.world.pose(run.boxes[i]).position - settled[i]), 1e-3f) << "box " << i + 1;
}

TEST(scenes_run, boxes_on_a_slope_slide_above_the_angle_of_friction) {
    constexpr float k_time = 2.0f, k_substep = 1.0f / 240.0f; // s
    for (const int degrees : {27, 35, 45}) {
        SCOPED_TRACE(degrees);
        SceneRun run("slope:friction=0.5,angle=" + std::to_string(degrees));
        run.world.step(120);
        const float angle = static_cast<float>(degrees) * std::numbers::pi_v<float> / 180.0f;
        const float braking = 9.81f * 0.5f * std::cos(angle);
        const float expected = 0.5f * (9.81f * std::sin(angle) - braking) * k_time * k_time;
        // Friction is bounded by the normal impulse so far, so that it sets in late by up to a sub-step.
        const float late = braking * k_substep * k_time;
        for (std::size_t i = 0; i < run.boxes.size(); ++i) {
            const Vec3 moved = run.world.pose(run.boxes[i]).position - run.starts[i].position;
            EXPECT_LT(moved.x, 0.0f);
            EXPECT_NEAR(length(moved), expected, late) << "box " << i + 1;
        }
    }
}

TEST(Worlds, of_one_scene_never_meet) {
    constexpr std::uint32_t k_boxes = 20;
    World world({}, tests::options_on(DeviceKind::Cpu));
    const std::vector<BodyDefinition> bodies = tests::bodies_of("worlds:count=9,boxes=20");
    world.add(bodies);
    world.step(60);
    const std::uint32_t first = static_cast<std::uint32_t>(bodies.size()) - 9 * k_boxes; // behind the ground
    std::size_t inside = 0;
    for (const CollisionPair& pair : world.collision_pairs()) {
        if (pair.a.index < first || pair.b.index < first) continue;
        ++inside;
        EXPECT_EQ((pair.a.index - first) / k_boxes, (pair.b.index - first) / k_boxes);
    }
    EXPECT_GT(inside, 9u);
}

} // namespace
} // namespace talus::scenes
