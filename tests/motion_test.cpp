// SPDX-License-Identifier: MIT
// Bodies that touch nothing, on every device: free flight, spin, damping, the limits of speed. Each tolerance says
// where it comes from: the integrator's order, or floats, which round at 6e-8 a sub-step.
#include <numbers>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

class Motion : public OnDevice {};

// ---- free flight ----

TEST_P(Motion, a_body_falls_as_galileo_says) {
    World world = make_world();
    const BodyId id = world.add(box_at({0.0f, 100.0f, 0.0f}));
    world.step(120);
    // Two seconds. The step is right for a constant force; rounding: 960 times 6e-8 of 20 m/s, and 120 times of 100 m.
    EXPECT_NEAR(world.velocity(id).linear.y, -k_gravity * 2.0f, 1e-3f);
    EXPECT_NEAR(world.pose(id).position.y, 100.0f - k_gravity * 2.0f, 1e-3f);
}

TEST_P(Motion, a_projectile_flies_a_parabola) {
    World world = make_world();
    BodyDefinition definition = sphere_at({0.0f, 10.0f, 0.0f});
    definition.velocity.linear = {8.0f, 12.0f, -3.0f};
    const BodyId id = world.add(definition);
    for (int tenth = 1; tenth <= 20; ++tenth) {
        world.step(6);
        const float t = 0.1f * static_cast<float>(tenth);
        EXPECT_NEAR(world.pose(id).position.x, 8.0f * t, 1e-4f) << t;
        EXPECT_NEAR(world.pose(id).position.z, -3.0f * t, 1e-4f) << t;
        EXPECT_NEAR(world.pose(id).position.y, 10.0f + 12.0f * t - 0.5f * k_gravity * t * t, 3e-4f) << t;
    }
}

TEST_P(Motion, a_constant_force_gives_a_parabola) {
    World world = make_world();
    BodyDefinition definition = sphere_at({});
    definition.mass = 2.0f;
    definition.gravity_scale = 0.5f;
    const BodyId id = world.add(definition);
    for (int i = 0; i < 60; ++i) {
        world.add_force(id, {6.0f, 0.0f, 0.0f});
        world.step();
    }
    EXPECT_NEAR(world.pose(id).position.x, 1.5f, 1e-4f); // 3 m/s² for a second
    EXPECT_NEAR(world.pose(id).position.y, -0.25f * k_gravity, 1e-4f);
}

TEST_P(Motion, a_ball_that_brushes_a_wall_falls_freely) {
    World world = make_world();
    BodyDefinition wall = box_at({1.0f, 0.0f, 0.0f}, {1.0f, 20.0f, 1.0f}, BodyKind::Static);
    wall.material.friction = 0.0f;
    BodyDefinition ball = sphere_at({});
    ball.material.friction = 0.0f;
    ball.mass = 1.0f;
    world.add(wall);
    const BodyId id = world.add(ball);
    for (int i = 0; i < 60; ++i) {
        world.add_force(id, {0.5f, 0.0f, 0.0f}); // a twentieth of its weight
        world.step();
    }
    EXPECT_NEAR(world.pose(id).position.x, 0.0f, 1e-3f);
    // Held by the wall it would be 2 mm further down, as with 32 sub-steps. Rounding alone is 0.2 mm: the velocity of a
    // ball that falls for a second with nothing beside it is off by 0.3 mm/s after 480 sub-steps.
    EXPECT_NEAR(world.pose(id).position.y, -0.5f * k_gravity, 3e-4f);
}

TEST_P(Motion, half_the_step_halves_the_error_of_damping) {
    const auto error_with = [&](float dt) {
        Settings settings;
        settings.dt = dt;
        World world = make_world(settings);
        BodyDefinition definition = sphere_at({});
        definition.linear_damping = 1.0f;
        const BodyId id = world.add(definition);
        world.step(static_cast<std::uint32_t>(std::lround(1.0f / dt)));
        // v' = -g - v from rest: y = -g exp(-1) after 1 s.
        return std::abs(world.pose(id).position.y + k_gravity * std::exp(-1.0f));
    };
    // First order. Rounding, some 0.02 mm, is a three-hundredth of these errors of 26 to 6.5 mm at most.
    const float coarse = error_with(1.0f / 15.0f), fine = error_with(1.0f / 30.0f), finest = error_with(1.0f / 60.0f);
    EXPECT_NEAR(coarse / fine, 2.0f, 0.02f);
    EXPECT_NEAR(fine / finest, 2.0f, 0.02f);
}

TEST_P(Motion, an_undamped_body_keeps_its_velocity) {
    World world = make_world(weightless());
    BodyDefinition definition = sphere_at({});
    definition.velocity = {{3.0f, -2.0f, 1.0f}, {0.5f, 1.5f, -2.5f}};
    const BodyId id = world.add(definition);
    world.step(100);
    EXPECT_EQ(world.velocity(id), definition.velocity) << "to the last bit";
}

TEST_P(Motion, damping_decays_exponentially) {
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
    // It comes to a halt after v / c; what is left of the way after 10 s is exp(-5).
    world.step(540);
    EXPECT_NEAR(world.pose(id).position.x, 8.0f * (1.0f - std::exp(-5.0f)), 8.0f * 2e-3f);
}

// ---- spin ----

TEST_P(Motion, a_turning_sphere_turns_by_its_angular_velocity) {
    World world = make_world(weightless());
    BodyDefinition definition = sphere_at({});
    definition.velocity.angular = {2.0f, 3.0f, -6.0f}; // 7 rad/s
    const BodyId id = world.add(definition);
    world.step(60);
    const Quat expected = turn({2.0f / 7.0f, 3.0f / 7.0f, -6.0f / 7.0f}, 7.0f);
    const Quat q = world.pose(id).rotation;
    const float agreement = q.x * expected.x + q.y * expected.y + q.z * expected.z + q.w * expected.w;
    // The cosine of half the angle between them; 1e-6 is 3 mrad of the 7 rad turned.
    EXPECT_NEAR(std::abs(agreement), 1.0f, 1e-6f);
}

/// A book thrown about its axis of medium inertia, the one of its length 1 m, with a slight error.
BodyDefinition thrown_book() {
    BodyDefinition definition = box_at({}, {1.0f, 2.0f, 0.4f});
    definition.mass = 3.0f;
    definition.velocity.angular = {0.05f, 0.05f, 6.0f};
    definition.pose.rotation = turn({0.0f, 1.0f, 0.0f}, std::numbers::pi_v<float> / 2.0f); // that axis along z
    return definition;
}

TEST_P(Motion, a_free_body_keeps_its_energy_and_angular_momentum) {
    World world = make_world(weightless());
    const BodyId id = world.add(thrown_book());
    const glm::dvec3 momentum = spin(world, id);
    const double energy = kinetic_energy(world, id);
    for (int second = 1; second <= 60; ++second) {
        world.step(60);
        // The midpoint rule keeps the energy and the length of the angular momentum; they were seen to drift by 4e-5 a
        // second. The direction is as good as the rotation.
        const double tolerance = second <= 5 ? 1e-3 : 0.01;
        EXPECT_NEAR(kinetic_energy(world, id) / energy, 1.0, tolerance) << second;
        EXPECT_NEAR(glm::length(spin(world, id)) / glm::length(momentum), 1.0, tolerance) << second;
        EXPECT_LT(glm::length(spin(world, id) - momentum) / glm::length(momentum), 0.01) << second;
    }
}

TEST_P(Motion, a_book_thrown_about_its_middle_axis_flips) {
    World world = make_world(weightless());
    const BodyId id = world.add(thrown_book());
    // Dzhanibekov: the body's own axis turns over, again and again, while the spin in space stays as it was.
    int flips = 0;
    double side = 1.0;
    for (int i = 0; i < 60; ++i) {
        world.step(10);
        const double along =
            glm::dot(exact(world.velocity(id).angular), exact(world.pose(id).rotation) * glm::dvec3(-1.0, 0.0, 0.0));
        if (along * side < -3.0) {
            side = -side;
            ++flips;
        }
    }
    EXPECT_GE(flips, 3);
}

TEST_P(Motion, a_spin_about_the_largest_or_the_smallest_inertia_is_stable) {
    for (const Vec3 axis : {Vec3{0.0f, 1.0f, 0.0f}, Vec3{0.0f, 0.0f, 1.0f}}) {
        World world = make_world(weightless());
        BodyDefinition definition = box_at({}, {1.0f, 2.0f, 0.4f});
        definition.velocity.angular = axis * 6.0f + Vec3{0.06f, 0.0f, 0.0f};
        const BodyId id = world.add(definition);
        for (int i = 0; i < 30; ++i) {
            world.step(10);
            const double along =
                glm::dot(exact(world.velocity(id).angular), exact(world.pose(id).rotation) * exact(axis));
            EXPECT_NEAR(along, 6.0, 0.06) << axis.y << ' ' << i;
        }
    }
}

// ---- limits ----

TEST_P(Motion, a_falling_body_stops_gaining_speed_at_the_limit) {
    Settings settings;
    settings.max_linear_speed = 5.0f; // after 0.51 s
    World world = make_world(settings);
    BodyDefinition definition = sphere_at({0.0f, 100.0f, 0.0f});
    definition.velocity.linear = {3.0f, 0.0f, 0.0f};
    const BodyId id = world.add(definition);
    for (int i = 0; i < 90; ++i) {
        world.step();
        EXPECT_LE(length(world.velocity(id).linear), 5.0f * (1.0f + 1e-6f)) << i;
    }
    EXPECT_NEAR(length(world.velocity(id).linear), 5.0f, 1e-5f);
    EXPECT_GT(world.velocity(id).linear.x, 0.1f) << "the direction is kept, not each component";
}

TEST_P(Motion, a_torque_spins_a_body_up_to_the_limit) {
    Settings settings = weightless();
    settings.max_angular_speed = 4.0f;
    World world = make_world(settings);
    BodyDefinition definition = sphere_at({});
    definition.inertia = Vec3{1.0f, 1.0f, 1.0f};
    const BodyId id = world.add(definition);
    for (int i = 0; i < 60; ++i) {
        world.add_torque(id, {0.0f, 6.0f, 0.0f}); // 6 rad/s²
        world.step();
        EXPECT_NEAR(world.velocity(id).angular.y, std::min(0.1f * static_cast<float>(i + 1), 4.0f), 1e-4f) << i;
    }
}

TALUS_ON_EVERY_DEVICE(Motion);

} // namespace
} // namespace talus::tests
