// SPDX-License-Identifier: MIT
// Bodies that their caller moves, on every device: they carry, push and throw others, and nothing slows them.
#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

class Kinematic : public OnDevice {};

/// A platform with its upper side at y = 0 and three boxes on it.
struct Lift {
    BodyId platform;
    std::vector<BodyId> boxes;

    explicit Lift(World& world) {
        platform = world.add(with_material(box_at({0.0f, -0.5f, 0.0f}, {4.0f, 1.0f, 4.0f}, BodyKind::Kinematic), 0.8f));
        for (int i = 0; i < 3; ++i)
            boxes.push_back(world.add(with_material(box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f}), 0.8f)));
    }

    /// One second of even acceleration to `speed`, then two at that speed; the largest offset of a box on the way.
    float ride(World& world, Vec3 speed) const {
        float largest = 0.0f;
        world.step(60);
        for (int i = 1; i <= 180; ++i) {
            world.set_velocity(platform, {speed * std::min(static_cast<float>(i) / 60.0f, 1.0f), {}});
            world.step();
            for (std::size_t k = 0; k < boxes.size(); ++k) {
                const Vec3 home = world.pose(platform).position + Vec3{0.0f, 1.0f + static_cast<float>(k), 0.0f};
                largest = std::max(largest, length(world.pose(boxes[k]).position - home));
            }
        }
        return largest;
    }
};

TEST_P(Kinematic, a_platform_carries_a_stack_sideways) {
    World world = make_world();
    const Lift lift(world);
    EXPECT_LT(lift.ride(world, {1.5f, 0.0f, 0.5f}), 0.02f) << "1.6 m/s², a fifth of what friction could give";
    for (const BodyId id : lift.boxes)
        EXPECT_LT(length(world.velocity(id).linear - Vec3{1.5f, 0.0f, 0.5f}), 0.01f * 1.6f);
}

TEST_P(Kinematic, a_platform_carries_a_stack_up_and_down) {
    for (const float speed : {3.0f, -3.0f}) {
        SCOPED_TRACE(speed);
        World world = make_world();
        const Lift lift(world);
        EXPECT_LT(lift.ride(world, {0.0f, speed, 0.0f}), 0.02f);
        for (const BodyId id : lift.boxes)
            EXPECT_NEAR(world.velocity(id).linear.y, speed, 0.01f * 3.0f);
    }
}

TEST_P(Kinematic, a_pusher_is_not_slowed) {
    World world = make_world();
    world.add(with_material(ground(), 0.5f));
    BodyDefinition pusher = with_material(box_at({0.0f, 0.6f, 0.0f}, {0.5f, 1.0f, 2.0f}, BodyKind::Kinematic), 0.5f);
    pusher.velocity.linear = {2.0f, 0.0f, 0.0f};
    const BodyId id = world.add(pusher);
    std::vector<BodyId> row;
    for (int i = 0; i < 4; ++i) {
        BodyDefinition box = with_material(box_at({1.5f + 1.2f * static_cast<float>(i), 0.5f, 0.0f}), 0.5f);
        box.density = 8000.0f;
        row.push_back(world.add(box));
    }
    world.step(120);
    EXPECT_EQ(world.velocity(id), pusher.velocity) << "to the last bit";
    EXPECT_NEAR(world.pose(id).position.x, 4.0f, 1e-4f);
    float front = world.pose(id).position.x + 0.25f;
    for (const BodyId box : row) {
        EXPECT_NEAR(world.velocity(box).linear.x, 2.0f, 0.01f * 2.0f);
        EXPECT_GT(world.pose(box).position.x - 0.5f - front, -0.02f) << "overlap";
        front = world.pose(box).position.x + 0.5f;
    }
}

TEST_P(Kinematic, a_bat_throws_a_ball_at_twice_its_speed) {
    World world = make_world(weightless());
    BodyDefinition bat = with_material(box_at({0.0f, 0.0f, 0.0f}, {0.5f, 2.0f, 2.0f}, BodyKind::Kinematic), 0.0f, 1.0f);
    bat.velocity.linear = {5.0f, 0.0f, 0.0f};
    world.add(bat);
    const BodyId ball = world.add(with_material(sphere_at({3.0f, 0.0f, 0.0f}), 0.0f, 1.0f));
    world.step(60);
    EXPECT_NEAR(world.velocity(ball).linear.x, 10.0f, 1e-3f);
}

// ---- a turntable ----

/// A table that turns at `rate` (rad/s), with its upper side at y = 0 and 3 m from the axis to a side's middle, and a
/// small flat box on it that turns with it at first.
struct Turntable {
    BodyId table, box;

    Turntable(World& world, float rate, float radius, float friction) {
        BodyDefinition top =
            with_material(box_at({0.0f, -0.5f, 0.0f}, {6.0f, 1.0f, 6.0f}, BodyKind::Kinematic), friction);
        top.velocity.angular = {0.0f, rate, 0.0f};
        table = world.add(top);
        BodyDefinition load = with_material(box_at({radius, 0.05f, 0.0f}, {0.2f, 0.1f, 0.2f}), friction);
        load.velocity = {{0.0f, 0.0f, -rate * radius}, {0.0f, rate, 0.0f}};
        box = world.add(load);
    }
};

float radius_of(const World& world, BodyId id) {
    const Vec3 p = world.pose(id).position;
    return std::hypot(p.x, p.z);
}

TEST_P(Kinematic, a_turntable_carries_what_friction_can_hold) {
    // mu g / r allows 2.2 rad/s.
    World world = make_world();
    const Turntable table(world, 1.8f, 1.0f, 0.5f);
    world.step(600);
    EXPECT_NEAR(radius_of(world, table.box), 1.0f, 0.01f);
    EXPECT_NEAR(length(world.velocity(table.box).linear), 1.8f, 0.01f * 1.8f);
    EXPECT_NEAR(world.velocity(table.box).angular.y, 1.8f, 0.01f * 1.8f);
}

/// The speed with which a small body leaves a turning table at 2.5 m from its axis, by Coulomb's law in small steps: it
/// is braked with mu g against its motion as seen from the table.
double speed_at_the_edge(double rate, double radius, double friction) {
    glm::dvec2 x{radius, 0.0}, v{0.0, -rate * radius};
    constexpr double k_small = 1e-5; // s
    while (glm::length(x) < 2.5) {
        const glm::dvec2 slip = v - rate * glm::dvec2(x.y, -x.x);
        const double speed = glm::length(slip);
        if (speed > 0.0) v -= slip / speed * std::min(friction * k_gravity * k_small, speed);
        x += v * k_small;
    }
    return glm::length(v);
}

TEST_P(Kinematic, a_turntable_flings_off_what_friction_cannot_hold) {
    for (const float friction : {0.0f, 0.2f, 0.4f}) {
        SCOPED_TRACE(friction);
        World world = make_world();
        const Turntable table(world, 4.0f, 1.0f, friction);
        for (int i = 0; i < 240 && radius_of(world, table.box) < 2.5f; ++i)
            world.step();
        ASSERT_GE(radius_of(world, table.box), 2.5f) << "it must come off";
        const float expected = static_cast<float>(speed_at_the_edge(4.0, 1.0, friction));
        EXPECT_NEAR(length(world.velocity(table.box).linear), expected, 0.02f * expected);
    }
}

TALUS_ON_EVERY_DEVICE(Kinematic);

} // namespace
} // namespace talus::tests
