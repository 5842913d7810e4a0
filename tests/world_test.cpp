// SPDX-License-Identifier: MIT
// The public calls of a world, on every device: bodies come and go, what is set can be read, forces do what they say,
// and results describe the last step.
#include <limits>
#include <set>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

constexpr float k_dt = 1.0f / 60.0f;

void expect_near(Vec3 a, Vec3 b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

class Worlds : public OnDevice {};

// ---- bodies ----

TEST_P(Worlds, say_what_they_run_on) {
    const World world = make_world();
    EXPECT_EQ(world.device().kind, GetParam());
    EXPECT_FALSE(world.device().name.empty());
    EXPECT_FALSE(world.device().driver.empty());
    EXPECT_FALSE(world.device().why.empty());
    EXPECT_EQ(world.device().threads, GetParam() == DeviceKind::Gpu ? 0u : 2u);
    EXPECT_GT(world.memory().device, 0u);
}

TEST_P(Worlds, without_bodies_step_too) {
    World world = make_world();
    world.step(3);
    EXPECT_EQ(world.step_count(), 3u);
    EXPECT_EQ(world.report().step, 3u);
    EXPECT_TRUE(world.contacts().empty());
    EXPECT_TRUE(world.poses().empty());
}

TEST_P(Worlds, give_back_what_was_put_in) {
    World world = make_world();
    BodyDefinition box = box_at({1.0f, 2.0f, 3.0f}, {0.5f, 1.0f, 2.0f});
    box.pose.rotation = turn({0.0f, 1.0f, 0.0f}, 0.5f);
    box.velocity = {{1.0f, -2.0f, 3.0f}, {0.1f, 0.2f, 0.3f}};
    box.density = 600.0f;
    box.gravity_scale = 0.25f;
    box.material = {0.7f, 0.2f, Combine::Multiply, Combine::Minimum};
    const BodyId a = world.add(box);
    BodyDefinition sphere = sphere_at({9.0f, 0.0f, 0.0f}, 0.3f);
    sphere.mass = 4.0f;
    const BodyId b = world.add(sphere);
    sphere.kind = BodyKind::Kinematic;
    sphere.inertia = Vec3{1.0f, 2.0f, 3.0f};
    const BodyId c = world.add(sphere);

    EXPECT_EQ(world.body_count(), 3u);
    EXPECT_EQ(world.bodies(), (std::vector<BodyId>{a, b, c}));
    EXPECT_EQ(world.kind(a), BodyKind::Rigid);
    EXPECT_EQ(world.kind(c), BodyKind::Kinematic);
    EXPECT_EQ(std::get<Box>(world.shape(a)).size, (Vec3{0.5f, 1.0f, 2.0f}));
    EXPECT_EQ(std::get<Sphere>(world.shape(b)).radius, 0.3f);
    EXPECT_FLOAT_EQ(world.mass(a), 600.0f);
    expect_near(world.inertia(a), {50.0f * 5.0f, 50.0f * 4.25f, 50.0f * 1.25f}, 1e-3f); // m/12 (y² + z²), ...
    EXPECT_FLOAT_EQ(world.mass(b), 4.0f);
    EXPECT_FLOAT_EQ(world.inertia(b).x, 0.4f * 4.0f * 0.09f);
    EXPECT_EQ(world.mass(c), std::numeric_limits<float>::infinity());
    EXPECT_EQ(world.inertia(c), (Vec3{1.0f, 2.0f, 3.0f}));
    EXPECT_EQ(world.pose(a).position, box.pose.position);
    EXPECT_NEAR(world.pose(a).rotation.y, box.pose.rotation.y, 1e-6f);
    EXPECT_EQ(world.velocity(a), box.velocity);
    EXPECT_EQ(world.gravity_scale(a), 0.25f);
    EXPECT_EQ(world.gravity_scale(b), 1.0f);
    EXPECT_EQ(world.gravity_scale(c), 0.0f) << "a kinematic body's default";
    EXPECT_EQ(world.material(a).friction, 0.7f);
    EXPECT_EQ(world.material(a).restitution, 0.2f);
    EXPECT_EQ(world.material(a).friction_combine, Combine::Multiply);
    EXPECT_EQ(world.material(a).restitution_combine, Combine::Minimum);
}

TEST_P(Worlds, change_what_is_set) {
    World world = make_world(weightless());
    const BodyId id = world.add(box_at({}));
    world.step(2);
    world.set_pose(id, {{4.0f, 5.0f, 6.0f}, turn({0.0f, 0.0f, 1.0f}, 1.0f)});
    world.set_velocity(id, {{0.0f, 6.0f, 0.0f}, {}});
    world.set_gravity_scale(id, -2.0f);
    world.set_material(id, {0.1f, 0.9f, Combine::Maximum, Combine::Average});
    EXPECT_EQ(world.pose(id).position, (Vec3{4.0f, 5.0f, 6.0f}));
    EXPECT_EQ(world.velocity(id).linear, (Vec3{0.0f, 6.0f, 0.0f}));
    EXPECT_EQ(world.gravity_scale(id), -2.0f);
    EXPECT_EQ(world.material(id).restitution, 0.9f);
    world.step();
    expect_near(world.pose(id).position, {4.0f, 5.1f, 6.0f}, 1e-5f);
    EXPECT_NEAR(world.pose(id).rotation.z, std::sin(0.5f), 1e-6f);
}

TEST_P(Worlds, let_bodies_come_and_go_between_steps) {
    World world = make_world();
    world.add(ground());
    std::vector<BodyId> ids;
    for (int i = 0; i < 10; ++i)
        ids.push_back(world.add(box_at({2.0f * static_cast<float>(i), 0.5f, 0.0f})));
    world.step(5);
    world.remove(ids[3]);
    world.remove(ids[7]);
    EXPECT_EQ(world.body_count(), 9u);
    EXPECT_EQ(world.poses().size(), 9u);
    for (const Contact& contact : world.contacts())
        EXPECT_TRUE(world.contains(contact.a) && world.contains(contact.b));
    world.step(5);
    EXPECT_EQ(world.contacts().size(), 8u);
    const BodyId late = world.add(box_at({6.0f, 0.5f, 0.0f}));
    world.step(5);
    EXPECT_EQ(world.contacts().size(), 9u);
    EXPECT_NEAR(world.pose(late).position.y, 0.5f, 2e-3f);
    for (const std::size_t i : {0u, 1u, 2u, 4u, 5u, 6u, 8u, 9u})
        EXPECT_NEAR(world.pose(ids[i]).position.x, 2.0f * static_cast<float>(i), 1e-4f) << i;
}

TEST_P(Worlds, never_let_an_id_be_valid_again) {
    World world = make_world(weightless());
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
    std::vector<BodyId> gone;
    for (int round = 0; round < 6; ++round) {
        std::vector<BodyId> ids;
        for (int i = 0; i < 4; ++i)
            ids.push_back(world.add(box_at({3.0f * static_cast<float>(i), 0.0f, 0.0f})));
        for (const BodyId id : ids)
            EXPECT_TRUE(seen.insert({id.index, id.generation}).second);
        for (const BodyId id : gone)
            EXPECT_FALSE(world.contains(id));
        if (round % 2 == 0) world.step();
        for (const BodyId id : ids) {
            world.remove(id);
            gone.push_back(id);
        }
        world.step();
    }
    EXPECT_EQ(world.body_count(), 0u);
    EXPECT_LT(gone.back().index, 24u) << "places are used again";
    EXPECT_FALSE(world.contains({}));
}

// ---- forces ----

TEST_P(Worlds, a_force_acts_for_one_step) {
    World world = make_world(weightless());
    BodyDefinition definition = box_at({});
    definition.mass = 2.0f;
    const BodyId id = world.add(definition);
    world.add_force(id, {60.0f, 0.0f, 0.0f});
    world.add_force(id, {60.0f, 120.0f, 0.0f}); // they add up
    EXPECT_EQ(world.velocity(id).linear, Vec3{}) << "a force needs time";
    world.step();
    expect_near(world.velocity(id).linear, {1.0f, 1.0f, 0.0f}, 1e-5f); // F dt / m
    world.step(3);
    expect_near(world.velocity(id).linear, {1.0f, 1.0f, 0.0f}, 1e-5f);
}

TEST_P(Worlds, a_force_off_the_centre_turns_too) {
    World world = make_world(weightless());
    BodyDefinition definition = box_at({1.0f, 0.0f, 0.0f});
    definition.mass = 2.0f;
    definition.inertia = Vec3{0.5f, 1.0f, 2.0f};
    const BodyId id = world.add(definition), turned = world.add([&] {
        BodyDefinition other = definition;
        other.pose.position = {5.0f, 0.0f, 0.0f};
        other.pose.rotation = turn({1.0f, 0.0f, 0.0f}, 1.57079633f); // its z axis points down: world y is its z
        return other;
    }());
    world.add_force(id, {0.0f, 60.0f, 0.0f}, {1.5f, 0.0f, 0.0f}); // torque 30 N m about z
    world.add_torque(turned, {0.0f, 30.0f, 0.0f});
    world.step();
    expect_near(world.velocity(id).linear, {0.0f, 0.5f, 0.0f}, 1e-5f);
    // The spin is about a principal axis, so the gyroscopic torque is nothing.
    expect_near(world.velocity(id).angular, {0.0f, 0.0f, 0.25f}, 1e-5f);
    expect_near(world.velocity(turned).angular, {0.0f, 0.25f, 0.0f}, 1e-5f);
}

TEST_P(Worlds, an_impulse_changes_the_velocity_at_once) {
    World world = make_world(weightless());
    BodyDefinition definition = box_at({1.0f, 0.0f, 0.0f});
    definition.mass = 2.0f;
    definition.inertia = Vec3{0.5f, 1.0f, 2.0f};
    const BodyId id = world.add(definition);
    world.add_impulse(id, {0.0f, 6.0f, 0.0f}, {1.5f, 0.0f, 0.0f});
    EXPECT_EQ(world.velocity(id).linear, (Vec3{0.0f, 3.0f, 0.0f}));
    EXPECT_EQ(world.velocity(id).angular, (Vec3{0.0f, 0.0f, 1.5f}));
    world.add_impulse(id, {2.0f, 0.0f, 0.0f});
    world.add_angular_impulse(id, {1.0f, 0.0f, 0.0f});
    EXPECT_EQ(world.velocity(id).linear, (Vec3{1.0f, 3.0f, 0.0f}));
    EXPECT_EQ(world.velocity(id).angular, (Vec3{2.0f, 0.0f, 1.5f}));
    world.step();
    EXPECT_EQ(world.velocity(id).linear, (Vec3{1.0f, 3.0f, 0.0f}));
}

TEST_P(Worlds, gravity_is_scaled_for_each_body) {
    World world = make_world();
    const BodyId free = world.add(box_at({0.0f, 0.0f, 0.0f}));
    BodyDefinition light = box_at({3.0f, 0.0f, 0.0f}), kinematic = box_at({6.0f, 0.0f, 0.0f});
    light.gravity_scale = -0.5f;
    kinematic.kind = BodyKind::Kinematic;
    kinematic.gravity_scale = 1.0f;
    const BodyId half = world.add(light), falling = world.add(kinematic);
    world.step(60);
    // Four roundings a step for 60 steps, of values near 10.
    EXPECT_NEAR(world.velocity(free).linear.y, -9.81f, 1e-4f);
    EXPECT_NEAR(world.velocity(half).linear.y, 4.905f, 1e-4f);
    EXPECT_NEAR(world.velocity(falling).linear.y, -9.81f, 1e-4f);
    world.set_gravity_scale(half, 0.0f);
    world.step(10);
    EXPECT_NEAR(world.velocity(half).linear.y, 4.905f, 1e-4f);
}

// ---- kinds ----

TEST_P(Worlds, a_static_body_never_moves) {
    World world = make_world();
    const BodyId floor = world.add(ground());
    world.add(sphere_at({0.0f, 3.0f, 0.0f}));
    const Pose before = world.pose(floor);
    world.step(60);
    EXPECT_EQ(world.pose(floor), before);
    EXPECT_EQ(world.velocity(floor), Velocity{});
}

TEST_P(Worlds, a_kinematic_body_moves_by_its_velocity_and_carries) {
    World world = make_world();
    BodyDefinition platform = box_at({0.0f, -0.5f, 0.0f}, {6.0f, 1.0f, 6.0f}, BodyKind::Kinematic);
    platform.velocity.linear = {0.5f, 0.0f, 0.0f};
    platform.material.friction = 1.0f;
    const BodyId carrier = world.add(platform);
    const BodyId load = world.add(with_material(box_at({0.0f, 0.5f, 0.0f}), 1.0f));
    world.step(120);
    EXPECT_NEAR(world.pose(carrier).position.x, 1.0f, 1e-4f);
    EXPECT_EQ(world.pose(carrier).position.y, -0.5f);
    EXPECT_EQ(world.velocity(carrier).linear, (Vec3{0.5f, 0.0f, 0.0f})) << "contacts do not push it";
    EXPECT_NEAR(world.velocity(load).linear.x, 0.5f, 1e-3f);
    // It slips until friction has brought it to 0.5 m/s: v²/(2 mu g) = 1.3 cm behind.
    EXPECT_NEAR(world.pose(load).position.x, 1.0f - 0.5f * 0.5f / (2.0f * 9.81f), 5e-3f);
}

// ---- results ----

TEST_P(Worlds, contacts_describe_a_resting_box) {
    World world = make_world();
    const BodyId floor = world.add(ground());
    BodyDefinition definition = box_at({2.0f, 0.5f, -1.0f});
    definition.mass = 10.0f;
    const BodyId box = world.add(definition);
    world.step(60);
    const std::vector<Contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].a, floor);
    EXPECT_EQ(contacts[0].b, box);
    expect_near(contacts[0].normal, {0.0f, 1.0f, 0.0f}, 1e-4f);
    ASSERT_EQ(contacts[0].points.size(), 4u);
    float sum = 0.0f;
    for (const ContactPoint& point : contacts[0].points) {
        sum += point.normal_impulse;
        EXPECT_NEAR(std::abs(point.position.x - 2.0f), 0.5f, 1e-3f);
        EXPECT_NEAR(std::abs(point.position.z + 1.0f), 0.5f, 1e-3f);
        EXPECT_NEAR(point.position.y, 0.0f, 2e-3f);
        EXPECT_LE(std::abs(point.separation), 2e-3f);
    }
    // What carries the weight for a step.
    const float weight = 10.0f * 9.81f * k_dt;
    EXPECT_NEAR(sum, weight, 0.01f * weight);
    ASSERT_EQ(world.collision_pairs().size(), 1u);
    EXPECT_EQ(world.collision_pairs()[0].a, floor);
    EXPECT_EQ(world.collision_pairs()[0].b, box);
    const StepReport report = world.report();
    EXPECT_EQ(report.pairs, 1u);
    EXPECT_EQ(report.manifolds, 1u);
    EXPECT_EQ(report.contacts, 4u);
    EXPECT_EQ(report.colours, 1u);
    EXPECT_EQ(report.step, 60u);
}

/// The one contact of a world is that of a box of 1 m, which stood on the ground there.
void expect_contact_under(const World& world, Vec3 place) {
    const std::vector<Contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1u);
    ASSERT_EQ(contacts[0].points.size(), 4u);
    for (const ContactPoint& point : contacts[0].points) {
        EXPECT_NEAR(std::abs(point.position.x - place.x), 0.5f, 1e-3f);
        EXPECT_NEAR(point.position.y, 0.0f, 2e-3f);
        EXPECT_NEAR(std::abs(point.position.z - place.z), 0.5f, 1e-3f);
    }
}

TEST_P(Worlds, contacts_lie_where_the_step_found_them) {
    for (const int box_place : {0, 1}) { // it is A, or B
        World world = make_world();
        BodyId box;
        for (const int place : {0, 1}) {
            if (place == box_place)
                box = world.add(with_material(box_at({0.0f, 0.5f, 0.0f}), 0.0f));
            else
                world.add(with_material(ground(), 0.0f));
        }
        world.step(30);
        world.set_velocity(box, {{30.0f, 0.0f, 0.0f}, {}}); // half a metre a step
        const Vec3 before = world.pose(box).position;
        world.step();
        ASSERT_NEAR(world.pose(box).position.x, before.x + 0.5f, 1e-3f);
        expect_contact_under(world, before);
        world.set_pose(box, {{0.0f, 20.0f, 0.0f}, {}});
        expect_contact_under(world, before);
        world.add(std::vector<BodyDefinition>(200, box_at({0.0f, 50.0f, 0.0f}))); // buffers grow
        expect_contact_under(world, before);
        World other = make_world();
        other.restore(world.snapshot());
        expect_contact_under(other, before);
        world.remove(box);
        EXPECT_TRUE(world.contacts().empty());
        world.restore(other.snapshot());
        expect_contact_under(world, before);
    }
}

TEST_P(Worlds, contact_impulses_carry_the_stack_above) {
    World world = make_world();
    world.add(ground());
    for (int i = 0; i < 5; ++i) {
        BodyDefinition definition = box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f});
        definition.mass = 10.0f;
        world.add(definition);
    }
    world.step(120);
    const std::vector<Contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 5u);
    for (const Contact& contact : contacts) {
        float sum = 0.0f;
        for (const ContactPoint& point : contact.points)
            sum += point.normal_impulse;
        const float carried = static_cast<float>(6 - contact.b.index);
        EXPECT_NEAR(sum / (carried * 10.0f * 9.81f * k_dt), 1.0f, 0.01f) << "under box " << contact.b.index;
    }
}

TEST_P(Worlds, poses_keep_coming_without_waiting) {
    World world = make_world();
    const BodyId id = world.add(box_at({0.0f, 50.0f, 0.0f}));
    EXPECT_TRUE(world.newest_poses().poses.empty());
    world.step();
    world.wait();
    EXPECT_TRUE(world.newest_poses().poses.empty()) << "the ring is off until it is asked for";
    world.keep_poses_coming(true);
    std::uint64_t last = 0;
    for (int i = 0; i < 30; ++i) {
        world.step();
        const World::PoseFrame frame = world.newest_poses();
        EXPECT_GE(frame.step, last);
        EXPECT_LE(frame.step, world.step_count());
        if (!frame.poses.empty()) {
            EXPECT_EQ(frame.poses.size(), 1u);
        }
        last = frame.step;
    }
    world.wait();
    const World::PoseFrame frame = world.newest_poses();
    EXPECT_EQ(frame.step, 31u);
    ASSERT_EQ(frame.poses.size(), 1u);
    EXPECT_EQ(frame.poses[0], world.pose(id));
}

TEST_P(Worlds, profile_every_stage_where_asked_to) {
    WorldOptions options = options_on(GetParam());
    options.profile = true;
    World profiled({}, options);
    profiled.add(ground());
    profiled.add(box_at({0.0f, 0.5f, 0.0f}));
    profiled.step(3);
    if (GetParam() != DeviceKind::Hybrid) {
        ASSERT_EQ(profiled.report().stage_ms.size(), stage_names().size());
        EXPECT_GT(profiled.report().step_ms, 0.0);
    }
    for (const double ms : profiled.report().stage_ms)
        EXPECT_GE(ms, 0.0);
    World plain = make_world();
    plain.step();
    EXPECT_TRUE(plain.report().stage_ms.empty());
}

// ---- time and settings ----

TEST_P(Worlds, the_broad_phase_follows_the_size_of_the_world_unless_one_is_asked_for) {
    World world = make_world();
    EXPECT_EQ(world.report().broad_phase, BroadPhase::Auto); // no step yet
    world.add(ground());
    for (int i = 1; i < 1024; ++i)
        world.add(box_at({2.0f * static_cast<float>(i), 0.5f, 0.0f}));
    world.step();
    world.wait();
    EXPECT_EQ(world.report().broad_phase, BroadPhase::SweepAndPrune);
    world.add(box_at({-2.0f, 0.5f, 0.0f}));
    world.step();
    world.wait();
    EXPECT_EQ(world.report().broad_phase, BroadPhase::Bvh);
    Settings settings = world.settings();
    settings.broad_phase = BroadPhase::SweepAndPrune;
    world.set_settings(settings);
    world.step();
    world.wait();
    EXPECT_EQ(world.report().broad_phase, BroadPhase::SweepAndPrune);
}

TEST_P(Worlds, settings_may_change_while_the_world_runs) {
    World world = make_world();
    world.add(bodies_of("stack:height=4"));
    const BodyId top = world.bodies().back();
    world.step(10);
    Settings settings = world.settings();
    settings.stabilisation = Stabilisation::Baumgarte;
    settings.iterations = 10;
    settings.broad_phase = BroadPhase::Brute;
    world.set_settings(settings);
    EXPECT_EQ(world.settings().stabilisation, Stabilisation::Baumgarte);
    world.step(20);
    EXPECT_NEAR(world.pose(top).position.y, 3.5f, 0.03f);
    settings = {};
    settings.dt = 1.0f / 240.0f;
    settings.substeps = 2;
    world.set_settings(settings);
    world.step(20);
    EXPECT_NEAR(world.pose(top).position.y, 3.5f, 0.03f);
    settings.gravity = {0.0f, 9.81f, 0.0f};
    world.set_settings(settings);
    world.step(24); // a tenth of a second
    EXPECT_NEAR(world.velocity(top).linear.y, 0.981f, 0.05f);
    EXPECT_EQ(world.step_count(), 74u);
}

TEST_P(Worlds, can_be_moved) {
    World first = make_world();
    const BodyId id = first.add(box_at({0.0f, 10.0f, 0.0f}));
    first.step(5);
    World second = std::move(first);
    EXPECT_EQ(second.step_count(), 5u);
    second.step(5);
    World third = make_world();
    third.step();
    third = std::move(second);
    EXPECT_EQ(third.step_count(), 10u);
    EXPECT_LT(third.pose(id).position.y, 10.0f);

    World whole = make_world();
    whole.add(box_at({0.0f, 10.0f, 0.0f}));
    whole.step(10);
    EXPECT_EQ(third.state_hash(), whole.state_hash());
}

TEST_P(Worlds, live_side_by_side) {
    World a = make_world(), b = make_world(), alone = make_world();
    for (World* world : {&a, &b, &alone})
        world->add(bodies_of("stack:height=3"));
    for (int i = 0; i < 10; ++i) {
        a.step();
        b.step(2);
    }
    alone.step(10);
    EXPECT_EQ(a.state_hash(), alone.state_hash());
    EXPECT_NE(b.state_hash(), alone.state_hash());
}

// ---- drawing ----

TEST_P(Worlds, name_their_gl_buffers_or_say_that_there_are_none) {
    World world = make_world();
    world.add(ground());
    world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.step();
    if (!has_gl()) {
        EXPECT_NE(error_of([&] { world.gl_buffers(); }).find("no OpenGL buffers"), std::string::npos);
        return;
    }
    const GlBuffers names = world.gl_buffers();
    const std::array contacts{names.manifolds, names.contact_points, names.point_separations, names.point_impulses};
    std::set<std::uint32_t> different{names.poses, names.starts,   names.shapes,      names.aabbs,
                                      names.pairs, names.counters, contacts[0].buffer};
    EXPECT_EQ(different.size(), 7u);
    EXPECT_FALSE(different.contains(0));
    constexpr std::array<std::uint64_t, 4> bytes_a_pair{64, 4 * 16, 32, 16};
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        EXPECT_EQ(contacts[i].buffer, contacts[0].buffer);
        EXPECT_EQ(contacts[i].offset % 256, 0u) << "a block may begin there";
        EXPECT_GE(contacts[i].size, bytes_a_pair[i] * names.pair_capacity);
        if (i == 0) continue;
        EXPECT_GE(contacts[i].offset, contacts[i - 1].offset + contacts[i - 1].size);
    }
    EXPECT_EQ(names.body_capacity, 2u);
    world.make_gl_current();
    world.step();
    EXPECT_EQ(world.step_count(), 2u);
}

TALUS_ON_EVERY_DEVICE(Worlds);

TEST(Devices, are_listed) {
    const std::vector<DeviceInfo> devices = list_devices();
    ASSERT_FALSE(devices.empty());
    EXPECT_EQ(devices.back().kind, DeviceKind::Cpu);
    EXPECT_GT(devices.back().threads, 0u);
}

TEST(Devices, in_software_come_after_those_in_hardware_and_are_never_taken_by_themselves) {
    bool software_seen = false;
    for (const DeviceInfo& device : list_devices()) {
        if (device.kind == DeviceKind::Cpu || device.name.empty()) continue;
        EXPECT_FALSE(software_seen && !device.in_software) << device.name;
        software_seen |= device.in_software;
        if (device.name.find("llvmpipe") != std::string::npos) {
            EXPECT_TRUE(device.in_software);
        }
    }
    EXPECT_FALSE(World().device().in_software);
}

TEST(Devices, auto_takes_one_and_says_why) {
    const World world;
    EXPECT_NE(world.device().kind, DeviceKind::Auto);
    EXPECT_FALSE(world.device().why.empty());
}

} // namespace
} // namespace talus::tests
