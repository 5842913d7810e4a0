// SPDX-License-Identifier: MIT
// What contacts may not change, on every device: linear and angular momentum; and what they have to carry: the weight.
#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

class Momentum : public OnDevice {};

TEST_P(Momentum, is_kept_when_two_boxes_collide) {
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
        EXPECT_GT(world.velocity(id_b).linear.x, 0.5f) << "they must have met";
        const glm::dvec3 sum = linear_momentum(world, id_a) + linear_momentum(world, id_b);
        EXPECT_LT(glm::length(sum - glm::dvec3(4.0, 0.0, 0.0)), 1e-5 * 4.0);
    }
}

/// Cubes and spheres that fly at each other from eight sides, each off the middle of the next. All turn alike about
/// every axis of theirs, so that free flight keeps each one's angular momentum to the last bits.
std::vector<BodyDefinition> crossfire(float restitution) {
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < 8; ++i) {
        const float angle = 0.7854f * static_cast<float>(i), offset = 0.15f * static_cast<float>(i % 3) - 0.15f;
        const Vec3 position{3.0f * std::cos(angle), offset, 3.0f * std::sin(angle)};
        BodyDefinition body = i % 2 == 0 ? box_at(position) : sphere_at(position);
        body.mass = 1.0f + 0.5f * static_cast<float>(i % 4);
        body.velocity = {{-3.0f * std::cos(angle) + 0.3f, -0.2f * offset, -3.0f * std::sin(angle)},
                         {0.5f * static_cast<float>(i % 5), -1.0f, 0.7f}};
        bodies.push_back(with_material(body, 0.4f, restitution));
    }
    return bodies;
}

struct Momenta {
    glm::dvec3 linear{}, angular{};
    double linear_scale = 0.0, angular_scale = 0.0; // sums of the magnitudes: what an error is measured by
};

Momenta momenta_of(const World& world) {
    Momenta m;
    for (const BodyId id : world.bodies()) {
        const glm::dvec3 linear = linear_momentum(world, id), angular = angular_momentum(world, id);
        m.linear += linear;
        m.angular += angular;
        m.linear_scale += glm::length(linear);
        m.angular_scale += glm::length(angular);
    }
    return m;
}

TEST_P(Momentum, is_kept_when_many_bodies_collide) {
    for (const float restitution : {0.0f, 1.0f}) {
        SCOPED_TRACE(restitution);
        World world = make_world(weightless());
        world.add(crossfire(restitution));
        const Momenta start = momenta_of(world);
        world.step(150);
        const Momenta end = momenta_of(world);
        EXPECT_LT(end.linear_scale, 0.95 * start.linear_scale) << "they must have met";
        EXPECT_LT(glm::length(end.linear - start.linear), 1e-5 * start.linear_scale);
    }
}

TEST_P(Momentum, of_turning_is_kept_when_many_bodies_collide) {
    for (const float restitution : {0.0f, 1.0f}) {
        SCOPED_TRACE(restitution);
        World world = make_world(weightless());
        world.add(crossfire(restitution));
        const Momenta start = momenta_of(world);
        world.step(150);
        EXPECT_LT(glm::length(momenta_of(world).angular - start.angular), 1e-5 * start.angular_scale);
    }
}

/// Each pair is pushed apart, so that the outer ones go at several times the speed of one push.
TEST_P(Momentum, is_kept_when_overlap_is_pushed_apart) {
    for (const float last_mass : {1.0f, 50.0f}) {
        SCOPED_TRACE(last_mass);
        World world = make_world(weightless());
        std::vector<BodyId> ids;
        for (int i = 0; i < 5; ++i) {
            const BodyDefinition box = with_material(box_at({0.6f * static_cast<float>(i), 0.0f, 0.0f}), 0.0f);
            ids.push_back(world.add(weighing(box, i == 4 ? last_mass : 1.0f)));
        }
        world.step(30);
        glm::dvec3 sum{};
        double scale = 0.0;
        for (const BodyId id : ids) {
            sum += linear_momentum(world, id);
            scale += glm::length(linear_momentum(world, id));
        }
        EXPECT_GT(scale, 5.0) << "they must have parted";
        EXPECT_LT(glm::length(sum), 1e-5 * scale);
    }
}

TEST_P(Momentum, is_kept_by_a_hub) {
    World world = make_world(with_hubs(weightless()));
    std::vector<BodyDefinition> bodies = plate_of(7);
    bodies.erase(bodies.begin()); // the ground
    for (std::size_t i = 1; i < bodies.size(); ++i) {
        bodies[i].pose.position.y += 0.1f;
        bodies[i].velocity.linear = {0.01f * static_cast<float>(i), -2.0f, 0.0f};
        if (i % 20 == 0) bodies[i].mass = 50'000.0f; // carries much of the load
    }
    world.add(bodies);
    const Momenta start = momenta_of(world);
    std::uint32_t hubs = 0;
    for (int i = 0; i < 60; ++i) {
        world.step();
        hubs += world.report().hubs;
    }
    const Momenta end = momenta_of(world);
    EXPECT_GT(hubs, 0u) << "they must have met";
    EXPECT_LT(glm::length(end.linear - start.linear), 1e-5 * start.linear_scale);
    EXPECT_LT(glm::length(end.angular - start.angular), 1e-5 * start.angular_scale);
}

// ---- impulses ----

/// The sum of the normal impulses between a body and the bodies below it (N s).
float impulse_under(const World& world, BodyId id) {
    float sum = 0.0f;
    for (const Contact& contact : world.contacts())
        if (contact.b == id)
            for (const ContactPoint& point : contact.points)
                sum += point.normal_impulse * contact.normal.y;
    return sum;
}

TEST_P(Momentum, contacts_carry_the_stack_above_over_the_whole_step) {
    World world = make_world();
    world.add(ground());
    std::vector<BodyId> boxes;
    for (int i = 0; i < 5; ++i) {
        BodyDefinition definition = box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f});
        definition.mass = 10.0f;
        boxes.push_back(world.add(definition));
    }
    world.step(120);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const float weight = 10.0f * static_cast<float>(boxes.size() - i) * k_gravity * k_dt;
        EXPECT_NEAR(impulse_under(world, boxes[i]) / weight, 1.0f, 0.01f) << "under box " << i;
    }
}

TEST_P(Momentum, contacts_carry_what_lies_on_a_hub) {
    World world = make_world(with_hubs());
    const std::vector<BodyId> ids = world.add(two_plates(7));
    world.step(240);
    EXPECT_EQ(world.report().hubs, 2u);
    float on_the_ground = 0.0f;
    for (const Contact& contact : world.contacts())
        if (contact.a == ids[0] || contact.b == ids[0])
            for (const ContactPoint& point : contact.points)
                on_the_ground += point.normal_impulse * std::abs(contact.normal.y);
    float mass = 0.0f;
    for (std::size_t i = 1; i < ids.size(); ++i)
        mass += world.mass(ids[i]);
    EXPECT_NEAR(on_the_ground / (mass * k_gravity * k_dt), 1.0f, 0.01f);
}

TEST_P(Momentum, a_box_on_a_slope_presses_with_the_cosine_of_its_weight) {
    World world = make_world();
    const Quat tilt = turn({0.0f, 0.0f, 1.0f}, -0.3f);
    BodyDefinition slope = with_material(box_at({}, {20.0f, 1.0f, 10.0f}, BodyKind::Static), 0.8f);
    slope.pose.rotation = tilt;
    world.add(slope);
    BodyDefinition box = with_material(box_at(rotated(tilt, {0.0f, 1.0f, 0.0f})), 0.8f);
    box.mass = 10.0f;
    box.pose.rotation = tilt;
    const BodyId id = world.add(box);
    world.step(120);
    const float expected = 10.0f * std::cos(0.3f) * k_gravity * k_dt;
    EXPECT_NEAR(impulse_under(world, id) / std::cos(0.3f) / expected, 1.0f, 0.01f);
}

TEST_P(Momentum, contacts_give_the_impulse_of_every_step_impacts_included) {
    for (const float restitution : {0.0f, 0.6f, 1.0f}) {
        SCOPED_TRACE(restitution);
        World world = make_world();
        world.add(with_material(ground(), 0.0f, restitution));
        BodyDefinition ball = with_material(sphere_at({0.0f, 2.0f, 0.0f}), 0.0f, restitution);
        ball.mass = 10.0f;
        const BodyId id = world.add(ball);
        float speed = 0.0f, hardest = 0.0f;
        for (int i = 0; i < 180; ++i) {
            world.step();
            const float change = 10.0f * (world.velocity(id).linear.y - speed + k_gravity * k_dt);
            const float impulse = impulse_under(world, id);
            ASSERT_NEAR(impulse, change, 0.01f) << "step " << i;
            speed = world.velocity(id).linear.y;
            hardest = std::max(hardest, impulse);
        }
        EXPECT_GT(hardest, 40.0f) << "it must have come down";
    }
}

TALUS_ON_EVERY_DEVICE(Momentum);

} // namespace
} // namespace talus::tests
