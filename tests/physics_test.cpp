// SPDX-License-Identifier: MIT
// Motion with closed forms, on every device. Each tolerance says where it comes from: the step is h = dt / 4 = 4.2 ms,
// a soft contact at rest sinks by well under a millimetre, and floats round at 6e-8 a step.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

constexpr float k_gravity = 9.81f;   // m/s²
constexpr float k_dt = 1.0f / 60.0f; // s
constexpr float k_h = k_dt / 4.0f;   // s, the sub-step

class Physics : public OnDevice {};

// ---- free flight ----

TEST_P(Physics, a_body_falls_as_the_integrator_says) {
    World world = make_world();
    const BodyId id = world.add(box_at({0.0f, 100.0f, 0.0f}));
    world.step(120);
    // Semi-implicit Euler after n sub-steps: v = -g n h, y = -g h² n (n + 1) / 2. Rounding: 480 times 6e-8 of 100 m.
    const float n = 480.0f;
    EXPECT_NEAR(world.velocity(id).linear.y, -k_gravity * n * k_h, 1e-3f);
    EXPECT_NEAR(world.pose(id).position.y, 100.0f - k_gravity * k_h * k_h * n * (n + 1.0f) / 2.0f, 3e-3f);
}

TEST_P(Physics, a_projectile_flies_a_parabola) {
    World world = make_world();
    BodyDefinition definition = sphere_at({0.0f, 10.0f, 0.0f});
    definition.velocity.linear = {8.0f, 12.0f, -3.0f};
    const BodyId id = world.add(definition);
    world.step(60);
    // The exact parabola; semi-implicit Euler is g h t / 2 = 2 cm below it after a second.
    EXPECT_NEAR(world.pose(id).position.x, 8.0f, 1e-4f);
    EXPECT_NEAR(world.pose(id).position.z, -3.0f, 1e-4f);
    EXPECT_NEAR(world.pose(id).position.y, 10.0f + 12.0f - 0.5f * k_gravity, 0.5f * k_gravity * k_h + 1e-3f);
}

TEST_P(Physics, an_undamped_body_keeps_its_velocity) {
    World world = make_world(weightless());
    BodyDefinition definition = sphere_at({});
    definition.velocity = {{3.0f, -2.0f, 1.0f}, {0.5f, 1.5f, -2.5f}};
    const BodyId id = world.add(definition);
    world.step(100);
    EXPECT_EQ(world.velocity(id), definition.velocity) << "to the last bit";
}

TEST_P(Physics, damping_decays_exponentially) {
    World world = make_world(weightless());
    BodyDefinition definition = sphere_at({});
    definition.velocity = {{4.0f, 0.0f, 0.0f}, {0.0f, 4.0f, 0.0f}};
    definition.linear_damping = 0.5f;
    definition.angular_damping = 1.0f;
    const BodyId id = world.add(definition);
    world.step(60);
    // (1 + h c)^-n against exp(-c t): off by c² h t / 2 = 0.2 % at most.
    EXPECT_NEAR(world.velocity(id).linear.x, 4.0f * std::exp(-0.5f), 4.0f * 1e-3f);
    EXPECT_NEAR(world.velocity(id).angular.y, 4.0f * std::exp(-1.0f), 4.0f * 2e-3f);
}

TEST_P(Physics, an_asymmetric_body_tumbles_without_losing_energy_or_angular_momentum) {
    World world = make_world(weightless());
    BodyDefinition definition = box_at({}, {1.0f, 2.0f, 0.4f});
    definition.mass = 3.0f;
    definition.velocity.angular = {0.05f, 0.05f, 6.0f}; // near the unstable axis is the one of medium inertia
    definition.pose.rotation = turn({0.0f, 1.0f, 0.0f}, std::numbers::pi_v<float> / 2.0f);
    const BodyId id = world.add(definition);
    const Vec3 inertia = world.inertia(id);
    const auto turned = [](Quat q, Vec3 v) {
        const Vec3 u{q.x, q.y, q.z};
        const auto cross = [](Vec3 a, Vec3 b) {
            return Vec3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
        };
        const Vec3 t = cross(u, v) * 2.0f;
        return v + t * q.w + cross(u, t);
    };
    const auto momentum = [&] {
        const Quat q = world.pose(id).rotation;
        const Vec3 w = turned({-q.x, -q.y, -q.z, q.w}, world.velocity(id).angular);
        return turned(q, {inertia.x * w.x, inertia.y * w.y, inertia.z * w.z});
    };
    const auto energy = [&] {
        const Vec3 l = momentum(), w = world.velocity(id).angular;
        return 0.5f * (l.x * w.x + l.y * w.y + l.z * w.z);
    };
    const Vec3 start = momentum();
    const float start_energy = energy();
    bool tumbled = false;
    for (int i = 0; i < 30; ++i) {
        world.step(10);
        const Quat q = world.pose(id).rotation;
        tumbled |= std::abs(turned({-q.x, -q.y, -q.z, q.w}, world.velocity(id).angular).y) > 3.0f;
        // The midpoint rule keeps the energy and the length of the angular momentum; its direction is only as good as
        // the rotation, whose second-order error over five seconds is below 2 %.
        EXPECT_NEAR(energy() / start_energy, 1.0f, 1e-3f) << i;
        EXPECT_NEAR(length(momentum()) / length(start), 1.0f, 1e-3f) << i;
        EXPECT_LT(length(momentum() - start) / length(start), 0.02f) << i;
    }
    EXPECT_TRUE(tumbled) << "the spin must change its axis for this to say something";
}

// ---- collisions ----

TEST_P(Physics, momentum_is_kept_in_a_collision) {
    for (const float restitution : {0.0f, 1.0f}) {
        SCOPED_TRACE(restitution);
        World world = make_world(weightless());
        BodyDefinition a = with_material(box_at({-2.0f, 0.1f, 0.2f}), 0.5f, restitution);
        a.mass = 1.0f;
        a.velocity.linear = {4.0f, 0.0f, 0.0f};
        BodyDefinition b = with_material(box_at({0.0f, 0.0f, 0.0f}, {1.0f, 2.0f, 1.0f}), 0.5f, restitution);
        b.mass = 3.0f;
        const BodyId id_a = world.add(a), id_b = world.add(b);
        world.step(60);
        const Vec3 va = world.velocity(id_a).linear, vb = world.velocity(id_b).linear;
        EXPECT_GT(vb.x, 0.5f) << "they must have met";
        EXPECT_NEAR(va.x + 3.0f * vb.x, 4.0f, 1e-4f);
        EXPECT_NEAR(va.y + 3.0f * vb.y, 0.0f, 1e-4f);
        EXPECT_NEAR(va.z + 3.0f * vb.z, 0.0f, 1e-4f);
    }
}

TEST_P(Physics, equal_spheres_exchange_their_velocities) {
    World world = make_world(weightless());
    BodyDefinition a = with_material(sphere_at({-2.0f, 0.0f, 0.0f}), 0.0f, 1.0f);
    a.velocity.linear = {5.0f, 0.0f, 0.0f};
    const BodyId id_a = world.add(a), id_b = world.add(with_material(sphere_at({0.0f, 0.0f, 0.0f}), 0.0f, 1.0f));
    world.step(60);
    // The impulse of a head-on impact is exact but for the roundings of the effective mass.
    EXPECT_NEAR(world.velocity(id_a).linear.x, 0.0f, 1e-3f);
    EXPECT_NEAR(world.velocity(id_b).linear.x, 5.0f, 1e-3f);
}

TEST_P(Physics, a_ball_bounces_to_the_square_of_the_restitution) {
    for (const float e : {0.0f, 0.5f, 0.8f}) {
        SCOPED_TRACE(e);
        World world = make_world();
        world.add(with_material(ground(), 0.5f, e));
        constexpr float k_drop = 2.0f; // m
        const BodyId id = world.add(with_material(sphere_at({0.0f, 0.5f + k_drop, 0.0f}), 0.5f, e));
        float highest = 0.0f;
        bool has_hit = false;
        for (int i = 0; i < 110; ++i) {
            world.step();
            has_hit |= world.pose(id).position.y < 0.55f;
            if (has_hit && world.velocity(id).linear.y >= 0.0f)
                highest = std::max(highest, world.pose(id).position.y - 0.5f);
        }
        // The impact comes a part of a step early or late, of 16.7 ms at 6.3 m/s, which is 10 cm of the 2 m fallen: 5
        // %.
        EXPECT_NEAR(highest, e * e * k_drop, 0.05f * k_drop);
    }
}

// ---- friction ----

TEST_P(Physics, a_sliding_box_stops_where_friction_has_used_its_energy) {
    World world = make_world();
    world.add(with_material(ground(), 0.5f));
    BodyDefinition box = with_material(box_at({0.0f, 0.25f, 0.0f}, {2.0f, 0.5f, 2.0f}), 0.3f); // average: 0.4
    box.velocity.linear = {4.0f, 0.0f, 0.0f};
    const BodyId id = world.add(box);
    world.step(120);
    EXPECT_NEAR(world.velocity(id).linear.x, 0.0f, 1e-3f);
    // v² / (2 mu g) = 2.04 m; the last sub-step and the settling of the contact leave 3 %.
    const float expected = 16.0f / (2.0f * 0.4f * k_gravity);
    EXPECT_NEAR(world.pose(id).position.x, expected, 0.03f * expected);
}

TEST_P(Physics, a_slope_holds_below_the_angle_of_friction_and_not_above) {
    constexpr float k_friction = 0.5f; // holds up to 26.6 degrees
    for (const float degrees : {20.0f, 25.0f, 28.0f, 35.0f}) {
        SCOPED_TRACE(degrees);
        const float angle = degrees * std::numbers::pi_v<float> / 180.0f;
        const Quat tilt = turn({0.0f, 0.0f, 1.0f}, -angle); // down towards +x
        const Vec3 normal{std::sin(angle), std::cos(angle), 0.0f}, downhill{std::cos(angle), -std::sin(angle), 0.0f};
        World world = make_world();
        BodyDefinition slope = with_material(box_at({}, {60.0f, 1.0f, 10.0f}, BodyKind::Static), k_friction);
        slope.pose.rotation = tilt;
        world.add(slope);
        BodyDefinition box = with_material(box_at(normal * 0.75f, {1.0f, 0.5f, 1.0f}), k_friction);
        box.pose.rotation = tilt;
        const BodyId id = world.add(box);
        const auto along = [&](Vec3 v) { return v.x * downhill.x + v.y * downhill.y; };
        world.step(30);
        const float speed = along(world.velocity(id).linear);
        world.step(60);
        const float gained = along(world.velocity(id).linear) - speed; // in a second
        const Vec3 way = world.pose(id).position - normal * 0.75f;
        const float acceleration = k_gravity * (std::sin(angle) - k_friction * std::cos(angle));
        if (acceleration < 0.0f) {
            EXPECT_NEAR(along(way), 0.0f, 1e-3f) << "it holds";
        } else {
            // The normal impulses, which bound the friction, are right to a few thousandths.
            EXPECT_NEAR(gained, acceleration, 0.002f * k_gravity);
            EXPECT_GT(along(way), 0.2f);
        }
        EXPECT_NEAR(way.z, 0.0f, 1e-3f) << "straight down";
        EXPECT_NEAR(world.velocity(id).linear.z, 0.0f, 1e-3f);
    }
}

TEST_P(Physics, a_ball_rolls_without_slipping) {
    World world = make_world();
    world.add(with_material(ground(), 0.8f));
    BodyDefinition ball = with_material(sphere_at({0.0f, 0.5f, 0.0f}), 0.8f);
    ball.velocity.linear = {3.5f, 0.0f, 0.0f};
    const BodyId id = world.add(ball);
    world.step(120);
    // It slides at first; then v = 5/7 of its speed, as angular momentum about the ground is kept.
    EXPECT_NEAR(world.velocity(id).linear.x, 2.5f, 0.02f);
    EXPECT_NEAR(world.velocity(id).angular.z, -2.5f / 0.5f, 0.05f);
    EXPECT_NEAR(world.pose(id).position.y, 0.5f, 2e-3f);
}

// ---- rest ----

TEST_P(Physics, a_stack_of_ten_stands) {
    World world = make_world();
    world.add(bodies_of("stack:height=10"));
    const std::vector<Pose> start = world.poses();
    world.step(300);
    const std::vector<Pose> end = world.poses();
    for (std::size_t i = 0; i < start.size(); ++i) {
        EXPECT_LT(length(end[i].position - start[i].position), 0.05f) << "box " << i;
        EXPECT_NEAR(std::abs(end[i].rotation.w), 1.0f, 1e-4f) << "box " << i;
    }
    for (const Velocity& velocity : world.velocities())
        EXPECT_LT(length(velocity.linear), 0.02f);
}

TEST_P(Physics, baumgarte_holds_a_stack_too) {
    Settings settings;
    settings.stabilisation = Stabilisation::Baumgarte;
    settings.iterations = 10;
    World world = make_world(settings);
    world.add(bodies_of("stack:height=5"));
    const BodyId top = world.bodies().back();
    for (int i = 0; i < 30; ++i) {
        world.step(10);
        // Equation 3.17 leaves up to the slop of 5 mm a contact, and trembles: its bias stays in the velocities.
        const Vec3 off = world.pose(top).position - Vec3{0.0f, 4.5f, 0.0f};
        EXPECT_NEAR(off.y, 0.0f, 0.03f) << world.step_count();
        EXPECT_LT(std::hypot(off.x, off.z), 0.03f) << world.step_count();
    }
}

TEST_P(Physics, overlapping_boxes_part_without_a_leap) {
    World world = make_world();
    world.add(ground());
    const BodyId id = world.add(box_at({0.0f, 0.3f, 0.0f})); // 20 cm in the ground
    float highest = 0.0f;
    for (int i = 0; i < 120; ++i) {
        world.step();
        highest = std::max(highest, world.pose(id).position.y);
    }
    EXPECT_NEAR(world.pose(id).position.y, 0.5f, 5e-3f);
    EXPECT_LT(highest, 0.55f) << "pushed apart, not thrown";
}

TALUS_ON_EVERY_DEVICE(Physics);

} // namespace
} // namespace talus::tests
