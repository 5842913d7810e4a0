// SPDX-License-Identifier: MIT
// Contacts that last: what two bodies that have hardly moved on each other take over from the last step is what a
// collision would find, and nothing that the caller changes is missed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>

#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

using engine::uint;

// ---- turns in a word ----

TEST(Turns, are_known_to_a_part_of_their_largest_component) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> part(-1.0f, 1.0f), exponent(-25.0f, 0.9f);
    for (int i = 0; i < 10000; ++i) {
        const float size = std::exp2(exponent(random));
        const engine::vec3 turn = engine::vec3(part(random), part(random), part(random)) * size;
        const uint word = engine::pack_turn(turn);
        ASSERT_NE(word, engine::k_no_turn_known);
        const engine::vec3 known = engine::unpack_turn(word);
        const float largest = std::max({std::abs(turn.x), std::abs(turn.y), std::abs(turn.z)});
        for (int k = 0; k < 3; ++k)
            ASSERT_LE(std::abs(known[k] - turn[k]), largest / 256.0f) << turn[k] << " of " << largest;
    }
}

TEST(Turns, of_what_stays_are_nothing) {
    using namespace engine;
    std::mt19937 random(10);
    std::uniform_real_distribution<float> part(-1.0f, 1.0f);
    for (int round = 0; round < 1000; ++round) {
        const BodyPose pose{vec3(part(random)), 0,
                            normalise_quaternion(vec4(part(random), part(random), part(random), part(random)))};
        EXPECT_EQ(start_of_still(pose).turn, start_at(pose, pose).turn);
    }
}

TEST(Turns, of_nothing_are_nothing_and_large_ones_stay_large) {
    const engine::vec3 none = engine::unpack_turn(engine::pack_turn(engine::vec3(0.0f)));
    EXPECT_EQ(none, engine::vec3(0.0f));
    for (const float size : {2.0f, 3.0f, 1e6f, 3e38f})
        for (const float sign : {-1.0f, 1.0f}) {
            const uint word = engine::pack_turn(engine::vec3(sign * size));
            EXPECT_NE(word, engine::k_no_turn_known);
            EXPECT_GT(sign * engine::unpack_turn(word).x, 1.9f);
        }
    const float least = std::exp2(-38.0f); // the last bit of what is told apart
    EXPECT_LE(std::abs(engine::unpack_turn(engine::pack_turn(engine::vec3(least))).x), 2.0f * least);
}

// ---- contacts ----

class LastingContacts : public OnDevice {};
TALUS_ON_EVERY_DEVICE(LastingContacts);

/// As it is: what the caller says of it anew is what it was, but no contact lasts.
void touch_all(World& world, const std::vector<BodyId>& ids) {
    for (const BodyId id : ids)
        world.set_material(id, world.material(id));
}

std::vector<BodyDefinition> stack_of(int height) {
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < height; ++i)
        bodies.push_back(box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f}));
    return bodies;
}

TEST_P(LastingContacts, nothing_is_collided_where_a_stack_stands) {
    EngineRun run(options_on(GetParam()), stack_of(5));
    uint collided = 0;
    for (int i = 0; i < 200; ++i) {
        run.step();
        if (i >= 100) collided += run.counter(engine::k_counter_pairs_to_collide);
    }
    EXPECT_EQ(run.counter(engine::k_counter_pair_count), 5u);
    EXPECT_LE(collided, 5u) << "in 100 steps";
}

TEST_P(LastingContacts, are_what_a_collision_finds) {
    World lasting = make_world(), anew = make_world();
    std::vector<BodyId> ids;
    for (World* each : {&lasting, &anew}) {
        ids = each->add(stack_of(4));
        ids.push_back(each->add(box_at({3.0f, 0.26f, 0.0f}, {0.5f, 0.5f, 0.5f}))); // falls by a centimetre
    }
    for (int i = 0; i < 300; ++i) {
        touch_all(anew, ids);
        lasting.step();
        anew.step();
    }
    for (const BodyId id : ids)
        EXPECT_LT(length(lasting.pose(id).position - anew.pose(id).position), 2e-5f);
    const std::vector<Contact> contacts = lasting.contacts(), expected = anew.contacts();
    ASSERT_EQ(contacts.size(), expected.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        ASSERT_EQ(contacts[i].points.size(), expected[i].points.size());
        EXPECT_LT(length(contacts[i].normal - expected[i].normal), 1e-4f);
        for (std::size_t k = 0; k < contacts[i].points.size(); ++k) {
            EXPECT_NEAR(contacts[i].points[k].separation, expected[i].points[k].separation, 5e-6f);
            EXPECT_LT(length(contacts[i].points[k].position - expected[i].points[k].position), 1e-4f);
        }
    }
}

/// On a table that turns: as its turn is not known to the last bit all contacts seem to creep, each at a pace of its
/// own.
std::vector<BodyDefinition> boxes_on_a_table() {
    BodyDefinition table = box_at({0.0f, -0.5f, 0.0f}, {32.0f, 1.0f, 32.0f}, BodyKind::Kinematic);
    table.velocity.angular = {0.0f, 4e-4f, 0.0f};
    std::vector<BodyDefinition> bodies{table};
    for (uint i = 0; i < 12; ++i)
        bodies.push_back(box_at({3.0f + static_cast<float>(i), 0.4f, 0.0f}, {0.8f, 0.8f, 0.8f}));
    return bodies;
}

TEST_P(LastingContacts, are_collided_together_in_one_of_sixteen_steps) {
    EngineRun run(options_on(GetParam()), boxes_on_a_table());
    uint together = 0, elsewhere = 0, steps = 0;
    for (uint step = 1; step <= 600; ++step) {
        run.step();
        if (step <= 80) continue; // until they lie
        const uint collided = run.counter(engine::k_counter_pairs_to_collide);
        (engine::collides_early(step) ? together : elsewhere) += collided;
        steps += collided > 0 ? 1 : 0;
    }
    EXPECT_GE(together, 12u);
    EXPECT_GE(steps, 6u) << "not all have the same pace";
    EXPECT_EQ(elsewhere, 0u);
}

/// The step's number is part of what a snapshot holds.
TEST_P(LastingContacts, are_collided_in_the_same_steps_after_a_snapshot) {
    World went_on = make_world(), restored = make_world();
    went_on.add(boxes_on_a_table());
    went_on.step(410);
    restored.restore(went_on.snapshot());
    for (int i = 0; i < 10; ++i) {
        went_on.step(16);
        restored.step(16);
        ASSERT_EQ(restored.state_hash(), went_on.state_hash()) << i;
    }
}

/// Nor does it matter that such a step is done again with more room.
TEST_P(LastingContacts, are_collided_in_the_same_steps_where_one_is_done_again) {
    const auto world_with = [](const Capacities& capacities) {
        WorldOptions options = options_on(GetParam());
        options.capacities = capacities;
        Settings settings;
        settings.max_substeps = settings.substeps; // more of them would ask for launches as well
        return World(settings, options);
    };
    World tiny = world_with({1, 1, 1}), ample = world_with({256, 4096, 64});
    std::vector<BodyDefinition> heap;
    for (int i = 0; i < 27; ++i)
        heap.push_back(box_at({0.3f * static_cast<float>(i % 3), 0.15f + 0.3f * static_cast<float>(i / 9),
                               8.0f + 0.3f * static_cast<float>(i / 3 % 3)},
                              {0.3f, 0.3f, 0.3f}));
    constexpr std::uint32_t early = 416;
    ASSERT_TRUE(engine::collides_early(early));
    for (World* each : {&ample, &tiny}) {
        each->add(boxes_on_a_table());
        each->step(early - 1);
        each->add(heap);
    }
    const std::uint32_t growths = tiny.report().growths;
    for (World* each : {&ample, &tiny})
        each->step();
    EXPECT_GT(tiny.report().growths, growths);
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(tiny.state_hash(), ample.state_hash()) << i;
        tiny.step(16);
        ample.step(16);
    }
}

/// What stands on a table that turns moves with it, and its contacts with both.
TEST_P(LastingContacts, turn_with_their_bodies) {
    World world = make_world();
    BodyDefinition table = box_at({0.0f, -0.5f, 0.0f}, {10.0f, 1.0f, 10.0f}, BodyKind::Kinematic);
    constexpr float speed = 0.02f; // rad/s
    table.velocity.angular = {0.0f, speed, 0.0f};
    const BodyId table_id = world.add(table);
    const Vec3 place{3.0f, 0.5f, 0.0f};
    const BodyId box = world.add(box_at(place)), upper = world.add(box_at(place + Vec3{0.0f, 1.0f, 0.0f}));
    constexpr int steps = 900;
    world.step(steps);
    const float angle = speed * steps / 60.0f; // 0.3
    const Vec3 expected{3.0f * std::cos(angle), 0.5f, -3.0f * std::sin(angle)};
    EXPECT_LT(length(world.pose(box).position - expected), 0.003f);
    EXPECT_LT(length(world.pose(upper).position - expected - Vec3{0.0f, 1.0f, 0.0f}), 0.003f);
    EXPECT_NEAR(2.0f * std::asin(world.pose(box).rotation.y), angle, 0.001f);
    for (const Contact& contact : world.contacts()) {
        ASSERT_EQ(contact.points.size(), 4u);
        const bool on_table = contact.a == table_id || contact.b == table_id;
        for (const ContactPoint& point : contact.points) { // the corners, as the boxes are turned now
            const Vec3 arm = point.position - (expected + Vec3{0.0f, on_table ? -0.5f : 0.5f, 0.0f});
            EXPECT_NEAR(std::abs(arm.x * std::cos(angle) - arm.z * std::sin(angle)), 0.5f, 0.004f);
            EXPECT_NEAR(std::abs(arm.x * std::sin(angle) + arm.z * std::cos(angle)), 0.5f, 0.004f);
        }
    }
}

/// A drawbridge: what lies far out on it is small, and moves by much more than it turns.
TEST_P(LastingContacts, hold_far_out_on_what_turns_slowly) {
    World lasting = make_world(), anew = make_world();
    std::vector<BodyId> ids;
    constexpr float speed = 0.01f; // rad/s
    for (World* each : {&lasting, &anew}) {
        BodyDefinition bridge = box_at({0.0f, -0.05f, 0.0f}, {12.0f, 0.1f, 2.0f}, BodyKind::Kinematic);
        bridge.velocity.angular = {0.0f, 0.0f, speed};
        ids = {each->add(bridge), each->add(box_at({5.5f, 0.05f, 0.0f}, {0.1f, 0.1f, 0.1f}))};
    }
    for (int step = 1; step <= 600; ++step) {
        touch_all(anew, ids);
        lasting.step();
        anew.step();
        ASSERT_LT(length(lasting.pose(ids[1]).position - anew.pose(ids[1]).position), 4e-4f) << step;
    }
}

// ---- what the caller changes ----

TEST_P(LastingContacts, have_a_new_material_at_once) {
    World world = make_world();
    BodyDefinition slope = box_at({0.0f, 0.0f, 0.0f}, {20.0f, 2.0f, 20.0f}, BodyKind::Static);
    constexpr float angle = 0.2f;
    slope.pose.rotation = turn({0.0f, 0.0f, 1.0f}, angle);
    slope.material.friction = 0.9f;
    const BodyId slope_id = world.add(slope);
    BodyDefinition box = box_at({-1.5f * std::sin(angle), 1.5f * std::cos(angle), 0.0f});
    box.pose.rotation = slope.pose.rotation;
    box.material.friction = 0.9f;
    const BodyId id = world.add(box);
    world.step(120);
    ASSERT_LT(length(world.velocity(id).linear), 0.001f);
    for (const BodyId each : {slope_id, id})
        world.set_material(each, {.friction = 0.0f});
    world.step();
    EXPECT_NEAR(length(world.velocity(id).linear), 9.81f * std::sin(angle) / 60.0f, 0.002f);
}

TEST_P(LastingContacts, end_where_a_body_becomes_a_sensor) {
    World world = make_world();
    world.add(ground());
    const BodyId id = world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.step(60);
    world.set_sensor(id, true);
    world.step();
    EXPECT_NEAR(world.velocity(id).linear.y, -9.81f / 60.0f, 0.001f);
    world.set_sensor(id, false);
    world.step();
    EXPECT_GT(world.velocity(id).linear.y, -0.05f) << "held again";
}

/// By so little that its own place says nothing: the turn of what the caller puts somewhere is not the step's.
TEST_P(LastingContacts, are_found_anew_where_the_caller_turns_a_body) {
    World world = make_world();
    const BodyId floor = world.add(ground());
    world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.step(60);
    constexpr float angle = 2e-5f;
    Pose pose = world.pose(floor);
    pose.rotation = turn({0.0f, 0.0f, 1.0f}, angle);
    world.set_pose(floor, pose);
    world.step();
    const std::vector<Contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].normal.x, -std::sin(angle), 1e-6f);
}

TEST_P(LastingContacts, know_of_changes_that_a_snapshot_was_made_with) {
    World world = make_world();
    const BodyId floor = world.add(ground());
    const BodyId id = world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.step(60);
    world.set_velocity(id, {{0.005f, 0.0f, 0.0f}, {}}); // 0.08 mm a step
    world.step();
    world.set_material(floor, {.friction = 0.1f});
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "talus_lasting_test.snapshot";
    world.snapshot().save(file);
    World other = make_world();
    other.restore(Snapshot::load(file));
    std::filesystem::remove(file);
    for (int step = 1; step <= 20; ++step) {
        world.step();
        other.step();
        ASSERT_EQ(world.state_hash(), other.state_hash()) << step;
    }
}

// ---- bodies that are apart ----

TEST_P(LastingContacts, begin_in_the_step_in_which_a_collision_finds_them) {
    Settings settings;
    settings.gravity = {};
    World lasting = make_world(settings), anew = make_world(settings);
    std::vector<BodyId> ids;
    for (World* each : {&lasting, &anew}) {
        BodyDefinition moving = box_at({1.06f, 0.3f, 0.0f});
        moving.velocity = {{-0.03f, 0.0f, 0.0f}, {0.0f, 0.02f, 0.03f}};
        ids = each->add(std::vector{box_at({}), moving});
    }
    int touched = 0;
    for (int step = 1; step <= 400 && touched == 0; ++step) {
        touch_all(anew, ids);
        lasting.step();
        anew.step();
        ASSERT_EQ(lasting.contacts().empty(), anew.contacts().empty()) << step;
        ASSERT_EQ(lasting.state_hash(), anew.state_hash()) << step;
        if (!lasting.contacts().empty()) touched = step;
    }
    EXPECT_GT(touched, 20);
}

TEST_P(LastingContacts, are_not_looked_for_where_bodies_stay_apart) {
    std::vector<BodyDefinition> bodies{ground()};
    const Quat rotation = turn({0.0f, 1.0f, 0.0f}, 0.785398f);
    for (int i = 0; i < 8; ++i) { // a row across the axes, near enough to be pairs, and too far apart to touch
        const float along = 1.014f * std::sqrt(0.5f) * static_cast<float>(i);
        bodies.push_back(box_at({along, 0.5f, -along}));
        bodies.back().pose.rotation = rotation;
    }
    EngineRun run(options_on(GetParam()), bodies);
    run.step();
    EXPECT_EQ(run.counter(engine::k_counter_pair_count), 15u);
    EXPECT_EQ(run.counter(engine::k_counter_pairs_to_collide), 15u) << "the bounding boxes overlap";
    run.step(99);
    EXPECT_EQ(run.counter(engine::k_counter_pair_count), 15u);
    EXPECT_EQ(run.counter(engine::k_counter_manifold_count), 8u);
    EXPECT_EQ(run.counter(engine::k_counter_pairs_to_collide), 0u);
}

/// Boxes of all sizes that move past each other by a little in each step: where the gap says that they are apart no
/// collision finds a point.
TEST(Gaps, are_never_larger_than_they_are) {
    using namespace engine;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> part(-1.0f, 1.0f), exponent(-3.0f, 3.0f), closeness(0.2f, 1.2f);
    const auto any = [&](float size) { return vec3(part(random), part(random), part(random)) * size; };
    const auto any_box = [&] {
        BodyShape shape{};
        shape.half_extents =
            vec3(0.3f) * vec3(std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random)));
        shape.type = k_shape_box | k_kind_rigid << 8;
        return shape;
    };
    const auto any_rotation = [&] {
        return normalise_quaternion(vec4(part(random), part(random), part(random), 0.1f + std::abs(part(random))));
    };
    Parameters p{};
    p.dt = 1.0f / 60.0f;
    p.speculative_distance = 0.012f;
    unsigned apart = 0, found = 0;
    for (int round = 0; round < 60000; ++round) {
        const BodyShape shape_a = any_box(), shape_b = any_box();
        BodyPose a{vec3(0.0f), 0, any_rotation()}, b{vec3(0.0f), 0, any_rotation()};
        b.position = any(1.0f);
        b.position = b.position * (closeness(random) * (length3(shape_a.half_extents) + length3(shape_b.half_extents)) /
                                   std::max(length3(b.position), 0.01f));
        const float speed = std::exp2(exponent(random) - 3.0f); // m/s
        BodyVelocity velocity_a{any(speed), 1.0f, any(speed), 0}, velocity_b{any(speed), 1.0f, any(speed), 0};
        float gap = 0.0f;
        for (int step = 0; step < 12; ++step) {
            const vec3 motion = motion_between(velocity_a, velocity_b, p);
            const ContactGeometry g = collide_moving_shapes(a, shape_a, b, shape_b, motion, no_carriers(),
                                                            contact_reach(motion, step % 2 == 1, p));
            if (is_surely_apart(gap, motion, p)) {
                ++apart;
                ASSERT_EQ(g.count, 0u) << "round " << round << ", step " << step << ", gap " << gap;
            }
            if (g.count > 0) ++found;
            if (step == 0) gap = g.count == 0 ? gap_without_points(g) : 0.0f;
            const BodyPose before_a = a, before_b = b;
            const auto move = [&](BodyPose& pose, const BodyVelocity& velocity) {
                pose.position = add_scaled(pose.position, velocity.linear, p.dt);
                pose.rotation = integrate_rotation(pose.rotation, velocity.angular, p.dt);
            };
            move(a, velocity_a);
            move(b, velocity_b);
            const BodyStart start_a = start_at(before_a, a), start_b = start_at(before_b, b);
            const MeetingPoint centre = centre_of_smaller(before_b.position - before_a.position, shape_a, shape_b);
            gap = gap_after(gap, way_between(last_movement(a, start_a), last_movement(b, start_b), centre));
        }
    }
    EXPECT_GT(apart, 20000u);
    EXPECT_GT(found, 20000u);
}

/// Two bars that cross, edge on edge, and move and turn on each other by a little: the contact that lasts is what a
/// collision finds.
TEST(LastingEdges, are_what_a_collision_finds) {
    using namespace engine;
    std::mt19937 random(12);
    std::uniform_real_distribution<float> part(-1.0f, 1.0f);
    const auto any = [&](float size) { return vec3(part(random), part(random), part(random)) * size; };
    const auto turned = [](vec4 rotation, vec3 turn) {
        return normalise_quaternion(
            multiply_quaternions(vec4(0.5f * turn.x, 0.5f * turn.y, 0.5f * turn.z, 1.0f), rotation));
    };
    Parameters p{};
    p.dt = 1.0f / 60.0f;
    p.speculative_distance = 0.012f;
    p.most_substeps = 8;
    BodyShape shape{};
    shape.half_extents = vec3(0.05f, 0.05f, 1.0f);
    shape.type = k_shape_box | k_kind_rigid << 8;
    const float up = 0.05f * std::sqrt(2.0f);
    const vec4 on_edge = turned(vec4(0.0f, 0.0f, 0.0f, 1.0f), vec3(0.0f, 0.0f, 0.828427f)); // by 45 degrees
    unsigned lasting = 0, at_edges = 0, parallel = 0;
    for (int round = 0; round < 4000; ++round) {
        BodyPose a{vec3(0.0f), 0, turned(on_edge, any(0.05f))};
        const float angle = 3.1f * part(random);
        const vec4 about(0.0f, std::sin(0.5f * angle), 0.0f, std::cos(0.5f * angle));
        BodyPose b{vec3(0.1f * part(random), 2.0f * up - 0.002f, 0.1f * part(random)), 0,
                   turned(multiply_quaternions(about, on_edge), any(0.05f))};
        const auto collided = [&] {
            return collide_shapes(a, shape, b, shape, no_carriers(), contact_reach(vec3(0.0f), true, p));
        };
        const ContactGeometry first = collided();
        if (first.count != 1 || first.axis < 6) continue;
        ++at_edges;
        Manifold manifold = make_manifold({0, 1}, first, {}, {});
        Separations separations = make_separations(first);
        vec3 anchor = first.points[0];
        for (int step = 0; step < 20; ++step) {
            const BodyPose before_a = a, before_b = b;
            a = {a.position + any(5e-6f), 0, turned(a.rotation, any(5e-6f))};
            b = {b.position + any(5e-6f), 0, turned(b.rotation, any(5e-6f))};
            const BodyStart start_a = start_at(before_a, a), start_b = start_at(before_b, b);
            const vec3 offset = before_b.position - before_a.position;
            const Movement by_a = last_movement(a, start_a), by_b = last_movement(b, start_b);
            const MeetingPoint meeting = meeting_point(anchor, offset, shape, shape);
            const LastingAxis axis = lasting_axis(manifold, by_a, by_b, a, b);
            const float way = way_after(separations, way_between(by_a, by_b, meeting), axis.leverage);
            const Movement still{vec3(0.0f), vec3(0.0f)};
            if (!stays(way, still, still, meeting, axis.leverage, most_way(false, p))) {
                parallel += step == 0 ? 1 : 0;
                break;
            }
            manifold = lasting_manifold(manifold, axis.normal, p);
            const vec4 opening(opening_at(axis.normal, anchor, offset, by_a, by_b));
            separations = lasting_separations(separations, opening, way, 1);
            anchor = lasting_anchor(anchor, offset, by_a, by_b);
            const ContactGeometry now = collided();
            ASSERT_EQ(now.count, 1u) << "round " << round;
            ASSERT_EQ(now.axis, first.axis) << "round " << round;
            EXPECT_EQ(now.normal, manifold.normal) << "round " << round;
            EXPECT_NEAR(now.separations[0], separations.separation.x, 1e-6f) << "round " << round;
            EXPECT_LT(length3(now.points[0] - anchor), 0.375e-3f + 2e-6f) << "round " << round;
            ++lasting;
        }
    }
    EXPECT_GT(at_edges, 2000u);
    EXPECT_GT(lasting, 20000u);
    EXPECT_GT(parallel, 4u); // some are so nearly, and move so far along each other in one step
}

} // namespace
} // namespace talus::tests
