// SPDX-License-Identifier: MIT
// Bounces, on every device.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

class Restitution : public OnDevice {};
class LongRestitution : public OnDevice {};

/// m. A body is seen half a step from its highest place at most, g dt² / 8 below it; a hit is as late as its time
/// within the sub-step is known, g h² / 2.
constexpr float k_between_steps = 4e-4f;

/// How high a body comes after its first impact on the ground, which it meets at `rest` (m).
float height_of_bounce(World& world, BodyDefinition body, float e, float rest, float drop) {
    world.add(with_material(ground(), 0.5f, e));
    body.pose.position = {0.0f, rest + drop, 0.0f};
    const BodyId id = world.add(with_material(body, 0.5f, e));
    float highest = 0.0f, lowest = drop;
    bool rises = false;
    for (int i = 0; i < 240; ++i) {
        world.step();
        const bool rose = rises;
        rises = world.velocity(id).linear.y > 0.0f;
        const float height = world.pose(id).position.y - rest;
        lowest = std::min(lowest, height);
        if (rises || rose) highest = std::max(highest, height);
        if (rose && !rises && highest > 1e-3f) break; // past the top
    }
    EXPECT_LT(lowest, 0.15f)
        << "it must have come down"; // a step's way at most: it is seen before and after the impact
    return highest;
}

TEST_P(Restitution, a_ball_bounces_to_the_square_of_the_restitution) {
    for (const float e : {0.25f, 0.5f, 0.75f, 1.0f}) {
        for (const float drop : {1.0f, 2.0f, 3.3f}) {
            SCOPED_TRACE("restitution " + std::to_string(e) + " from " + std::to_string(drop) + " m");
            World world = make_world();
            const float height = height_of_bounce(world, sphere_at({}), e, 0.5f, drop);
            EXPECT_NEAR(height, e * e * drop, k_between_steps);
        }
    }
}

TEST_P(Restitution, a_box_that_falls_flat_bounces_as_a_ball_does) {
    for (const float e : {0.5f, 1.0f}) {
        SCOPED_TRACE(e);
        World world = make_world();
        EXPECT_NEAR(height_of_bounce(world, box_at({}), e, 0.5f, 2.0f), e * e * 2.0f, k_between_steps);
    }
}

TEST_P(Restitution, a_ball_that_bounces_for_ever_keeps_its_energy) {
    World world = make_world();
    world.add(with_material(ground(), 0.0f, 1.0f));
    struct Fall {
        BodyId id;
        double energy; // J/kg
    };
    std::vector<Fall> falls;
    for (const float drop : {0.5f, 1.0f, 2.0f, 3.3f, 5.0f, 10.0f}) {
        const float x = 2.0f * static_cast<float>(falls.size());
        const BodyId id = world.add(with_material(sphere_at({x, 0.5f + drop, 0.0f}), 0.0f, 1.0f));
        falls.push_back({id, k_gravity * static_cast<double>(drop)});
    }
    for (int i = 0; i < 600; ++i) {
        world.step();
        for (const Fall& fall : falls) {
            const double speed = length(world.velocity(fall.id).linear);
            const double energy = k_gravity * (world.pose(fall.id).position.y - 0.5) + 0.5 * speed * speed;
            // Floats: a bounce takes and gives some 1e-6 of the velocity.
            ASSERT_NEAR(energy / fall.energy, 1.0, 1e-4)
                << "step " << i << ", from " << fall.energy / k_gravity << " m";
        }
    }
}

TEST_P(Restitution, a_gravity_scale_of_what_stands_changes_nothing) {
    World world = make_world();
    BodyDefinition floor = with_material(ground(), 0.0f, 1.0f);
    floor.gravity_scale = 100.0f;
    world.add(floor);
    const BodyId id = world.add(with_material(sphere_at({0.0f, 2.5f, 0.0f}), 0.0f, 1.0f));
    for (int i = 0; i < 300; ++i) {
        world.step();
        const double speed = length(world.velocity(id).linear);
        const double energy = k_gravity * (world.pose(id).position.y - 0.5) + 0.5 * speed * speed;
        ASSERT_NEAR(energy / (2.0 * k_gravity), 1.0, 1e-4) << "step " << i;
    }
}

TEST_P(Restitution, a_damped_ball_leaves_no_faster_than_it_came) {
    constexpr float k_damping = 100.0f, k_speed = 10.0f;
    for (int place = 0; place < 8; ++place) { // where in the step it meets the ground
        SCOPED_TRACE(place);
        Settings settings = weightless();
        settings.gravity.y = -0.1f;
        settings.dt = 1.0f / 480.0f;
        settings.substeps = settings.max_substeps = 1;
        World world = make_world(settings);
        world.add(with_material(ground(), 0.0f, 1.0f));
        const float height = k_speed * settings.dt * static_cast<float>(place) / 8.0f;
        BodyDefinition ball = with_material(sphere_at({0.0f, 0.5f + height, 0.0f}), 0.0f, 1.0f);
        ball.velocity.linear.y = -k_speed;
        ball.linear_damping = k_damping;
        const BodyId id = world.add(ball);
        world.step();
        // v / (1 + h c), and gravity's h g
        EXPECT_LE(length(world.velocity(id).linear), k_speed / (1.0f + settings.dt * k_damping) + 1e-3f);
    }
}

/// On the ground the first one turns round, hits the next, and so on, all in one step.
TEST_P(Restitution, ever_lighter_balls_throw_the_last_one_far) {
    World world = make_world();
    world.add(with_material(ground(), 0.0f, 1.0f));
    BodyId last{};
    float mass = 1.0f, y = 0.5f + 1.7f;
    for (int i = 0; i < 3; ++i) {
        last = world.add(weighing(with_material(sphere_at({0.0f, y, 0.0f}), 0.0f, 1.0f), mass));
        mass *= 0.3f;
        y += 1.0f;
    }
    const double start = mechanical_energy(world);
    float fastest_down = 0.0f, fastest_up = 0.0f;
    for (int i = 0; i < 60; ++i) {
        world.step();
        EXPECT_NEAR(mechanical_energy(world), start, 0.005 * start) << i;
        fastest_down = std::min(fastest_down, world.velocity(last).linear.y);
        fastest_up = std::max(fastest_up, world.velocity(last).linear.y);
    }
    // The second is thrown at v (4 / 1.3 - 1) = 2.077 v, and the last at (2 / 1.3) (2.077 + 1) v - v.
    EXPECT_NEAR(fastest_up / -fastest_down, 3.734f, 0.04f);
}

TEST_P(Restitution, without_it_nothing_bounces) {
    for (const BodyDefinition& body : {sphere_at({}), box_at({})}) {
        for (const float drop : {1.0f, 2.0f, 3.3f}) {
            SCOPED_TRACE(drop);
            World world = make_world();
            EXPECT_LT(height_of_bounce(world, body, 0.0f, 0.5f, drop), 1e-3f);
        }
    }
}

TEST_P(Restitution, equal_spheres_exchange_their_velocities) {
    World world = make_world(weightless());
    BodyDefinition a = with_material(sphere_at({-2.0f, 0.0f, 0.0f}), 0.0f, 1.0f);
    a.velocity.linear = {5.0f, 0.0f, 0.0f};
    const BodyId id_a = world.add(a), id_b = world.add(with_material(sphere_at({0.0f, 0.0f, 0.0f}), 0.0f, 1.0f));
    world.step(60);
    // The impulse of a head-on impact is exact but for the roundings of the effective mass.
    EXPECT_NEAR(world.velocity(id_a).linear.x, 0.0f, 1e-3f);
    EXPECT_NEAR(world.velocity(id_b).linear.x, 5.0f, 1e-3f);
}

TEST_P(Restitution, spheres_of_unequal_mass_part_as_an_elastic_impact_says) {
    World world = make_world(weightless());
    BodyDefinition a = with_material(sphere_at({-2.0f, 0.0f, 0.0f}), 0.0f, 1.0f);
    a.mass = 1.0f;
    a.velocity.linear = {5.0f, 0.0f, 0.0f};
    BodyDefinition b = with_material(sphere_at({0.0f, 0.0f, 0.0f}), 0.0f, 1.0f);
    b.mass = 4.0f;
    const BodyId id_a = world.add(a), id_b = world.add(b);
    world.step(60);
    EXPECT_NEAR(world.velocity(id_a).linear.x, -3.0f, 1e-3f); // (1 - 4) / 5 of 5 m/s
    EXPECT_NEAR(world.velocity(id_b).linear.x, 2.0f, 1e-3f);  // 2 / 5 of 5 m/s
}

TEST_P(Restitution, newtons_cradle_passes_the_momentum_on) {
    World world = make_world(weightless());
    BodyDefinition first = with_material(sphere_at({-2.0f, 0.0f, 0.0f}), 0.0f, 1.0f);
    first.velocity.linear = {3.0f, 0.0f, 0.0f};
    std::vector<BodyId> spheres{world.add(first)};
    for (int i = 0; i < 4; ++i)
        spheres.push_back(world.add(with_material(sphere_at({static_cast<float>(i), 0.0f, 0.0f}), 0.0f, 1.0f)));
    world.step(60);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(world.velocity(spheres[i]).linear.x, 0.0f, 0.05f * 3.0f) << "sphere " << i;
    EXPECT_NEAR(world.velocity(spheres[4]).linear.x, 3.0f, 0.05f * 3.0f);
}

/// Velocities of a row of five spheres, at rest but for the first ones, after these have met the others.
std::vector<float> after_the_cradle(World& world, std::size_t moving, float gap, float speed) {
    std::vector<BodyId> spheres;
    for (std::size_t i = 0; i < 5; ++i) {
        const float x = static_cast<float>(i) * (1.0f + gap) - (i < moving ? 2.0f : 0.0f);
        BodyDefinition sphere = with_material(sphere_at({x, 0.0f, 0.0f}), 0.0f, 1.0f);
        if (i < moving) sphere.velocity.linear.x = speed;
        spheres.push_back(world.add(sphere));
    }
    world.step(90);
    std::vector<float> velocities;
    for (const BodyId sphere : spheres)
        velocities.push_back(world.velocity(sphere).linear.x);
    return velocities;
}

TEST_P(Restitution, as_many_leave_newtons_cradle_as_came) {
    for (const std::size_t moving : {1u, 2u, 3u}) {
        for (const float gap : {0.0f, 0.001f, 0.01f}) {
            for (const float speed : {3.0f, 10.0f}) {
                World world = make_world(weightless());
                const std::vector<float> velocities = after_the_cradle(world, moving, gap, speed);
                float energy = 0.0f; // over that of a sphere at that speed
                for (const float velocity : velocities)
                    energy += velocity * velocity / (speed * speed);
                EXPECT_NEAR(energy, static_cast<float>(moving), 0.001f * static_cast<float>(moving));
                for (std::size_t i = 0; i < 5; ++i)
                    EXPECT_NEAR(velocities[i], i < 5 - moving ? 0.0f : speed, 0.05f * speed)
                        << moving << " at " << speed << " m/s, " << gap << " m apart, sphere " << i;
            }
        }
    }
}

TEST_P(Restitution, a_board_that_lands_a_little_tilted_bounces_on_both_edges) {
    constexpr float k_tilt = 0.02f, k_drop = 2.0f, k_thickness = 0.3f, k_length = 3.0f;
    World world = make_world();
    world.add(with_material(ground(), 0.5f, 0.8f));
    BodyDefinition board = with_material(box_at({}, {k_length, k_thickness, k_length}), 0.5f, 0.8f);
    board.pose.position.y = k_drop + 0.5f * (k_thickness * std::cos(k_tilt) + k_length * std::sin(k_tilt));
    board.pose.rotation = turn({0.0f, 0.0f, 1.0f}, k_tilt);
    const BodyId id = world.add(board);
    float highest = 0.0f;
    for (int i = 0; i < 110; ++i) {
        world.step();
        if (i >= 40) highest = std::max(highest, world.pose(id).position.y - 0.5f * k_thickness);
    }
    EXPECT_NEAR(highest, 0.87f, 0.05f) << "with a step of 1/1920 s it is 0.874 m";
}

TEST_P(Restitution, a_sphere_in_a_slot_bounces_many_times_a_step) {
    for (const float gap : {0.03f, 0.3f}) {
        World world = make_world(weightless());
        for (const float side : {-1.0f, 1.0f}) {
            const Vec3 place{side * (1.5f + 0.5f * gap), 0.0f, 0.0f};
            world.add(with_material(box_at(place, {2.0f, 9.0f, 9.0f}, BodyKind::Static), 0.0f, 1.0f));
        }
        BodyDefinition sphere = with_material(sphere_at({}), 0.0f, 1.0f);
        sphere.velocity.linear.x = 10.0f;
        const BodyId id = world.add(sphere);
        world.step(60);
        EXPECT_NEAR(length(world.velocity(id).linear), 10.0f, 0.01f) << gap;
    }
}

TEST_P(LongRestitution, a_gas_keeps_most_of_its_energy) {
    World world = make_world(weightless());
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-3.5f, 3.5f}) {
            const Vec3 place{axis == 0 ? side : 0.0f, axis == 1 ? side : 0.0f, axis == 2 ? side : 0.0f};
            const Vec3 size{axis == 0 ? 2.0f : 9.0f, axis == 1 ? 2.0f : 9.0f, axis == 2 ? 2.0f : 9.0f};
            world.add(with_material(box_at(place, size, BodyKind::Static), 0.0f, 1.0f));
        }
    }
    for (int i = 0; i < 27; ++i) {
        const auto place = [](int n) { return 1.53f * (static_cast<float>(n) - 1.0f); };
        const auto speed = [](int n) { return 2.0f * static_cast<float>(n); };
        BodyDefinition sphere =
            with_material(sphere_at({place(i % 3), place(i / 3 % 3), place(i / 9)}, 0.4f), 0.0f, 1.0f);
        sphere.velocity.linear = {speed(3 - i % 7), speed(i % 5 - 2), speed(i % 4 - 1)};
        world.add(sphere);
    }
    const double energy = mechanical_energy(world);
    world.step(600);
    // What meets slower than the threshold does not bounce. 24 starts kept 0.84 to 0.98 of their energy.
    EXPECT_GT(mechanical_energy(world), 0.8 * energy);
    EXPECT_LE(mechanical_energy(world), 1.001 * energy);
}

TEST_P(LongRestitution, a_body_at_rest_that_would_bounce_stays_at_rest) {
    for (const BodyDefinition& body : {sphere_at({0.0f, 0.5f, 0.0f}), box_at({0.0f, 0.5f, 0.0f})}) {
        World world = make_world();
        world.add(with_material(ground(), 0.5f, 1.0f));
        const BodyId id = world.add(with_material(body, 0.5f, 1.0f));
        const double energy = mechanical_energy(world);
        for (int second = 1; second <= 60; ++second) {
            world.step(60);
            EXPECT_LE(mechanical_energy(world), 1.001 * energy) << second;
            EXPECT_LT(length(world.velocity(id).linear), 1e-3f) << second;
        }
    }
}

TALUS_ON_EVERY_DEVICE(Restitution);
TALUS_ON_THE_CPU(LongRestitution);

} // namespace
} // namespace talus::tests
