// SPDX-License-Identifier: MIT
// Sleep, on every device: islands at rest stop, stay where they would have stayed, and wake in the step in which
// something touches or changes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <limits>

#include "parameters.h"
#include "parity.h"
#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

constexpr float k_box_weight = 1000.0f * 9.81f; // N, of a box of 1 m

Settings with_sleeping() {
    Settings settings;
    settings.sleeping = true;
    return settings;
}

/// Boxes of 1 m on top of each other.
std::vector<BodyId> add_stack(World& world, float x, int height = 3) {
    std::vector<BodyId> ids;
    for (int i = 0; i < height; ++i)
        ids.push_back(world.add(box_at({x, 0.5f + static_cast<float>(i), 0.0f})));
    return ids;
}

bool all_asleep(const World& world, const std::vector<BodyId>& ids) {
    return std::ranges::all_of(ids, [&](BodyId id) { return world.is_asleep(id); });
}
bool none_asleep(const World& world, const std::vector<BodyId>& ids) {
    return std::ranges::none_of(ids, [&](BodyId id) { return world.is_asleep(id); });
}

/// Steps until so many bodies sleep; how many steps that took.
int step_until_asleep(World& world, std::uint32_t count, int most = 240) {
    for (int i = 1; i <= most; ++i) {
        world.step();
        if (world.report().sleeping_bodies == count) return i;
    }
    ADD_FAILURE() << "after " << most << " steps " << world.report().sleeping_bodies << " bodies sleep, not " << count;
    return most;
}

/// More body slots than a small world has, far from everything: what makes a world large.
void add_ballast(World& world) {
    std::vector<BodyDefinition> ballast;
    for (int i = 0; i < 1030; ++i)
        ballast.push_back(box_at({3.0f * static_cast<float>(i % 32), -50.0f, 3.0f * static_cast<float>(i / 32)},
                                 {1.0f, 1.0f, 1.0f}, BodyKind::Static));
    world.add(ballast);
}

class Sleep : public OnDevice {
protected:
    /// A ground with a stack of three that sleeps.
    struct Sleepers {
        World world;
        BodyId floor = world.add(ground());
        std::vector<BodyId> stack = add_stack(world, 0.0f);
    };
    Sleepers make_sleepers() const {
        Sleepers made{make_world(with_sleeping())};
        step_until_asleep(made.world, 3);
        return made;
    }
};
TALUS_ON_EVERY_DEVICE(Sleep);

TEST_P(Sleep, is_off_unless_asked_for) {
    World world = make_world();
    world.add(ground());
    const std::vector<BodyId> stack = add_stack(world, 0.0f);
    world.step(90);
    EXPECT_TRUE(none_asleep(world, stack));
    EXPECT_EQ(world.report().sleeping_bodies, 0u);
    world.wake(stack[0]); // no harm
    world.step();
}

/// Each contact of a stack of three boxes carries what stands on it, to within a part of that.
void expect_loads_of_three(const World& world, float part) {
    for (std::size_t i = 0; const Contact& contact : world.contacts()) {
        float impulse = 0.0f;
        for (const ContactPoint& point : contact.points)
            impulse += point.normal_impulse;
        const float load = static_cast<float>(3 - i) * k_box_weight / 60.0f;
        EXPECT_NEAR(impulse, load, part * load) << i;
        ++i;
    }
}

TEST_P(Sleep, a_stack_falls_asleep_as_a_whole_and_stays_where_it_is) {
    World world = make_world(with_sleeping()), awake = make_world();
    std::vector<BodyId> stack;
    for (World* each : {&world, &awake}) {
        each->add(ground());
        stack = add_stack(*each, 0.0f);
    }
    int steps = 0;
    for (; world.report().sleeping_bodies == 0 && steps < 240; ++steps) {
        world.step();
        const auto sleeping = std::ranges::count_if(stack, [&](BodyId id) { return world.is_asleep(id); });
        EXPECT_TRUE(sleeping == 0 || sleeping == 3) << sleeping << " of 3 in step " << steps;
    }
    EXPECT_GE(steps, 30) << "half a second of rest";
    EXPECT_LT(steps, 120);
    EXPECT_TRUE(all_asleep(world, stack));
    EXPECT_EQ(world.report().manifolds, 3u);
    EXPECT_EQ(world.report().contacts, 12u);

    const std::uint64_t hash = world.state_hash();
    world.step(120);
    awake.step(static_cast<std::uint32_t>(steps) + 120);
    EXPECT_EQ(world.state_hash(), hash);
    for (const BodyId id : stack) {
        EXPECT_EQ(world.velocity(id), Velocity{});
        EXPECT_LT(length(world.pose(id).position - awake.pose(id).position), 0.001f);
    }
    // What is kept is of the last of 128 sub-steps, in which the last bit of a position is some hundredths of a load.
    expect_loads_of_three(world, 0.05f);
}

TEST_P(Sleep, a_stack_that_has_settled_keeps_its_loads) {
    Settings settings = with_sleeping();
    settings.sleep_time = 2.0f;
    World world = make_world(settings);
    world.add(ground());
    add_stack(world, 0.0f);
    step_until_asleep(world, 3);
    world.step(60);
    ASSERT_EQ(world.contacts().size(), 3u);
    expect_loads_of_three(world, 0.002f);
}

TEST_P(Sleep, keeps_contacts_bit_by_bit_while_other_pairs_come_and_go) {
    World world = make_world(with_sleeping());
    world.add(ground());
    const std::vector<BodyId> other = add_stack(world, 10.0f), stack = add_stack(world, 0.0f);
    step_until_asleep(world, 6);
    const auto contacts_of_stack = [&] {
        std::vector<Contact> contacts = world.contacts();
        std::erase_if(contacts,
                      [&](const Contact& contact) { return std::ranges::find(stack, contact.b) == stack.end(); });
        return contacts;
    };
    const std::vector<Contact> before = contacts_of_stack();
    ASSERT_EQ(before.size(), 3u);
    for (const BodyId id : other)
        world.remove(id);
    for (int i = 0; i < 5; ++i) // into the places that become free
        world.add(sphere_at({10.0f, 0.7f + 1.5f * static_cast<float>(i), 0.0f}));
    for (int i = 0; i < 20; ++i) {
        world.step();
        ASSERT_TRUE(all_asleep(world, stack));
        const std::vector<Contact> now = contacts_of_stack();
        ASSERT_EQ(now.size(), before.size());
        for (std::size_t c = 0; c < now.size(); ++c) {
            EXPECT_EQ(now[c].normal, before[c].normal);
            ASSERT_EQ(now[c].points.size(), before[c].points.size());
            for (std::size_t k = 0; k < now[c].points.size(); ++k) {
                EXPECT_EQ(now[c].points[k].position, before[c].points[k].position);
                EXPECT_EQ(now[c].points[k].separation, before[c].points[k].separation);
                EXPECT_EQ(now[c].points[k].normal_impulse, before[c].points[k].normal_impulse);
            }
        }
    }
}

TEST_P(Sleep, a_ball_wakes_the_stack_in_the_step_of_touch_and_no_other) {
    Sleepers made = make_sleepers();
    World& world = made.world;
    const std::vector<BodyId> other = add_stack(world, 10.0f);
    step_until_asleep(world, 6);
    BodyDefinition definition = sphere_at({-6.0f, 2.5f, 0.0f}, 0.25f);
    definition.velocity.linear = {10.0f, 1.0f, 0.0f};
    definition.mass = 500.0f;
    const BodyId ball = world.add(definition);
    bool touched = false;
    for (int i = 0; i < 60; ++i) {
        world.step();
        const std::vector<Contact> contacts = world.contacts();
        touched = touched || std::ranges::any_of(contacts, [&](const Contact& contact) {
                      return contact.b == ball && contact.a != made.floor;
                  });
        EXPECT_TRUE(touched ? none_asleep(world, made.stack) : all_asleep(world, made.stack)) << "step " << i;
        EXPECT_TRUE(all_asleep(world, other));
    }
    EXPECT_TRUE(touched);
    EXPECT_GT(world.pose(made.stack[2]).position.x, 0.01f) << "the ball pushes it";
}

TEST_P(Sleep, whatever_the_caller_does_to_one_body_wakes_its_island) {
    Sleepers made = make_sleepers();
    World& world = made.world;
    const BodyId box = made.stack[1];
    const std::vector<std::pair<const char*, std::function<void()>>> calls{
        {"wake", [&] { world.wake(box); }},
        {"add_force",
         [&] {
             world.add_force(box, {1.0f, 0.0f, 0.0f});
         }},
        {"add_torque",
         [&] {
             world.add_torque(box, {0.0f, 1.0f, 0.0f});
         }},
        {"add_impulse",
         [&] {
             world.add_impulse(box, {0.0f, 1.0f, 0.0f});
         }},
        {"set_velocity",
         [&] {
             world.set_velocity(box, {{0.0f, 0.01f, 0.0f}, {}});
         }},
        {"set_pose", [&] { world.set_pose(box, world.pose(box)); }},
        {"set_material", [&] { world.set_material(box, world.material(box)); }},
        {"the ground's set_material", [&] { world.set_material(made.floor, world.material(made.floor)); }},
        {"set_gravity_scale", [&] { world.set_gravity_scale(box, 1.0f); }},
        {"set_settings",
         [&] {
             Settings settings = world.settings();
             settings.gravity.y -= 0.01f;
             world.set_settings(settings);
         }},
    };
    for (const auto& [name, call] : calls) {
        SCOPED_TRACE(name);
        EXPECT_TRUE(all_asleep(world, made.stack));
        call();
        world.step();
        EXPECT_TRUE(none_asleep(world, made.stack));
        EXPECT_GE(step_until_asleep(world, 3), 29) << "the rest begins anew";
    }
    world.set_settings(world.settings());
    world.step();
    EXPECT_TRUE(all_asleep(world, made.stack)) << "nothing has changed";
}

TEST_P(Sleep, a_strong_push_moves_what_slept) {
    Sleepers made = make_sleepers();
    made.world.add_impulse(made.stack[2], {3000.0f, 0.0f, 0.0f});
    made.world.step(10);
    EXPECT_GT(made.world.pose(made.stack[2]).position.x, 0.2f);
}

TEST_P(Sleep, what_loses_its_support_falls) {
    const std::vector<std::pair<const char*, void (*)(Sleepers&)>> ways{
        {"the ground is removed", [](Sleepers& made) { made.world.remove(made.floor); }},
        {"the ground is moved away",
         [](Sleepers& made) {
             made.world.set_pose(made.floor, {{0.0f, -60.0f, 0.0f}, {}});
         }},
        {"the lowest box is removed", [](Sleepers& made) { made.world.remove(made.stack[0]); }},
        {"the lowest box is moved away",
         [](Sleepers& made) {
             made.world.set_pose(made.stack[0], {{0.0f, 30.0f, 0.0f}, {}});
         }},
    };
    for (const auto& [name, remove_support] : ways) {
        SCOPED_TRACE(name);
        Sleepers made = make_sleepers();
        const float before = made.world.pose(made.stack[2]).position.y;
        remove_support(made);
        made.world.step(15);
        EXPECT_NEAR(made.world.pose(made.stack[2]).position.y - before, -0.5f * 9.81f * 0.25f * 0.25f, 0.03f);
    }
}

TEST_P(Sleep, what_comes_to_touch_a_sleeper_wakes_it) {
    Sleepers made = make_sleepers();
    World& world = made.world;
    const BodyId top = world.add(box_at({0.0f, 3.5f, 0.0f}));
    world.step();
    EXPECT_TRUE(none_asleep(world, made.stack)) << "a box is added on top";
    step_until_asleep(world, 4);
    const BodyId block = world.add(box_at({0.99f, 0.5f, 0.0f}, {1.0f, 1.0f, 1.0f}, BodyKind::Static));
    world.step();
    EXPECT_TRUE(none_asleep(world, made.stack)) << "a static box is added inside";
    EXPECT_FALSE(world.is_asleep(top));
    world.remove(block);
    world.step();
    step_until_asleep(world, 4);
    const BodyId wall = world.add(box_at({5.0f, 0.5f, 0.0f}, {1.0f, 1.0f, 1.0f}, BodyKind::Static));
    world.step();
    EXPECT_TRUE(all_asleep(world, made.stack));
    world.set_pose(wall, {{0.995f + world.pose(made.stack[0]).position.x, 0.5f, 0.0f}, {}});
    world.step();
    EXPECT_TRUE(none_asleep(world, made.stack)) << "a static box is moved there";
}

TEST_P(Sleep, a_platform_wakes_what_stands_on_it_when_it_starts) {
    for (const bool large : {false, true}) {
        SCOPED_TRACE(large ? "large world" : "small world");
        World world = make_world(with_sleeping());
        if (large) add_ballast(world);
        world.add(ground());
        const BodyId platform = world.add(box_at({0.0f, 2.5f, 0.0f}, {4.0f, 1.0f, 4.0f}, BodyKind::Kinematic));
        std::vector<BodyId> boxes;
        for (int i = 0; i < 2; ++i)
            boxes.push_back(world.add(box_at({0.0f, 3.5f + static_cast<float>(i), 0.0f})));
        const std::vector<BodyId> other = add_stack(world, 20.0f, 2);
        step_until_asleep(world, 4);
        EXPECT_FALSE(world.is_asleep(platform));
        const float before = world.pose(boxes[1]).position.x;
        world.set_velocity(platform, {{0.5f, 0.0f, 0.0f}, {}});
        world.step();
        EXPECT_TRUE(none_asleep(world, boxes));
        world.step(59);
        EXPECT_TRUE(none_asleep(world, boxes)) << "as long as it moves";
        EXPECT_TRUE(all_asleep(world, other));
        EXPECT_NEAR(world.pose(boxes[1]).position.x - before, 0.5f, 0.05f);
        world.set_velocity(platform, {});
        step_until_asleep(world, 4);
    }
}

TEST_P(Sleep, a_kinematic_body_that_touches_nobody_moves_on_while_all_sleep) {
    World world = make_world(with_sleeping());
    add_ballast(world);
    world.add(ground());
    add_stack(world, 0.0f, 2);
    BodyDefinition mover = box_at({0.0f, 20.0f, 0.0f}, {1.0f, 1.0f, 1.0f}, BodyKind::Kinematic);
    mover.velocity.linear = {1.0f, 0.0f, 0.0f};
    const BodyId id = world.add(mover);
    const auto steps = static_cast<float>(step_until_asleep(world, 2) + 80); // launches that are not needed end
    world.step(80);
    EXPECT_NEAR(world.pose(id).position.x, steps / 60.0f, 0.001f);
}

TEST_P(Sleep, events_of_what_sleeps_go_on) {
    World world = make_world(with_sleeping());
    world.add(ground());
    const std::vector<BodyId> stack = add_stack(world, 0.0f);
    BodyDefinition definition = box_at({0.0f, 1.5f, 0.0f}, {2.0f, 3.5f, 2.0f}, BodyKind::Static);
    definition.sensor = true;
    world.add(definition);
    world.watch_contacts(ContactWatch::All);
    step_until_asleep(world, 3);
    world.take_contact_events();
    world.step(3);
    const std::vector<ContactEvent> events = world.take_contact_events();
    EXPECT_EQ(events.size(), 3u * 6u) << "three contacts and three boxes in the sensor, in each step";
    float on_the_ground = 0.0f;
    for (const ContactEvent& event : events) {
        EXPECT_EQ(event.phase, ContactPhase::Persist);
        if (event.b == stack[0] && !event.sensor && event.step == world.step_count())
            for (const ContactPoint& point : event.points)
                on_the_ground += point.normal_impulse;
    }
    const float load = 3.0f * k_box_weight / 60.0f;
    EXPECT_NEAR(on_the_ground, load, 0.02f * load);

    world.remove(stack[2]);
    world.step();
    const auto ends = [](const ContactEvent& event) { return event.phase == ContactPhase::End; };
    EXPECT_EQ(std::ranges::count_if(world.take_contact_events(), ends), 2) << "with the box below and the sensor";
}

TEST_P(Sleep, a_snapshot_holds_what_sleeps_and_who_is_about_to) {
    World world = make_world(with_sleeping());
    world.add(ground());
    const std::vector<BodyId> stack = add_stack(world, 0.0f), later = add_stack(world, 5.0f, 2);
    step_until_asleep(world, 5);
    world.wake(later[0]);
    world.step(20);
    const Snapshot saved = world.snapshot();
    const std::filesystem::path path = std::filesystem::temp_directory_path() / ("sleep" + name_of(GetParam()));
    saved.save(path);
    const int steps = step_until_asleep(world, 5);
    world.add_impulse(stack[2], {1000.0f, 0.0f, 0.0f});
    world.step(20);

    World again = make_world();
    again.restore(Snapshot::load(path));
    std::filesystem::remove(path);
    EXPECT_TRUE(all_asleep(again, stack));
    EXPECT_TRUE(none_asleep(again, later));
    EXPECT_EQ(again.report().sleeping_bodies, 3u);
    EXPECT_EQ(again.contacts().size(), 5u);
    EXPECT_EQ(step_until_asleep(again, 5), steps);
    again.add_impulse(stack[2], {1000.0f, 0.0f, 0.0f});
    again.step(20);
    EXPECT_EQ(again.state_hash(), world.state_hash());

    // What the caller has done since the last step is part of it.
    world.restore(saved);
    world.remove(stack[0]);
    const Snapshot removed = world.snapshot();
    again.restore(removed);
    again.step();
    EXPECT_FALSE(again.is_asleep(stack[1]));
}

TEST_P(Sleep, a_frozen_body_keeps_nobody_awake) {
    World world = make_world(with_sleeping());
    world.add(ground());
    const std::vector<BodyId> stack = add_stack(world, 0.0f, 2);
    const BodyId beside = world.add(box_at({1.005f, 0.5f, 0.0f}));
    BodyDefinition feather = box_at({-1.005f, 0.5f, 0.0f});
    feather.mass = 1.0e-12f; // 10¹² N on it overflow a float
    const BodyId wild = world.add(feather);
    world.step(5);
    for (int i = 0; i < 3; ++i) {
        world.add_force(wild, {1.0e12f, 0.0f, 1.0e12f});
        world.step();
    }
    EXPECT_EQ(world.report().frozen_bodies, 1u);
    step_until_asleep(world, 4);
    EXPECT_TRUE(all_asleep(world, stack) && world.is_asleep(beside));
}

TEST_P(Sleep, ends_when_it_is_turned_off) {
    Sleepers made = make_sleepers();
    Settings settings = made.world.settings();
    settings.sleeping = false;
    made.world.set_settings(settings);
    made.world.step();
    EXPECT_TRUE(none_asleep(made.world, made.stack));
    EXPECT_EQ(made.world.report().sleeping_bodies, 0u);
}

TEST_P(Sleep, counting_rest_changes_no_bit) {
    Settings never = with_sleeping();
    never.sleep_time = 10.0f;
    World counting = make_world(never), usual = make_world();
    for (World* world : {&counting, &usual}) {
        world->add(mixed_bodies());
        world->step(40);
    }
    EXPECT_EQ(counting.state_hash(), usual.state_hash());
}

TEST_P(Sleep, a_pile_ends_where_it_would_without) {
    World world = make_world(with_sleeping()), awake = make_world();
    for (World* each : {&world, &awake}) {
        each->add(bodies_of("pool:boxes=40"));
        each->step(360);
    }
    EXPECT_EQ(world.report().sleeping_bodies, 40u);
    const std::vector<Pose> with = world.poses(), without = awake.poses();
    for (std::size_t i = 0; i < with.size(); ++i)
        EXPECT_LT(length(with[i].position - without[i].position), 0.001f) << i;
}

/// The same story in a small and in a large world: sleepers, a ball that wakes one stack, growth on the way.
std::uint64_t hash_of_story(World& world, bool large, bool kinematic) {
    if (large) add_ballast(world);
    world.add(ground());
    const std::vector<BodyId> stack = add_stack(world, 0.0f);
    add_stack(world, 8.0f, 2);
    if (kinematic) world.add(box_at({0.0f, 9.0f, 0.0f}, {1.0f, 1.0f, 1.0f}, BodyKind::Kinematic));
    step_until_asleep(world, 5);
    BodyDefinition ball = sphere_at({-3.0f, 2.5f, 0.0f}, 0.3f);
    ball.velocity.linear = {12.0f, 0.0f, 0.5f};
    world.add(ball);
    world.step(40);
    EXPECT_EQ(world.report().sleeping_bodies, 2u);
    return world.state_hash();
}

// ---- islands that are too large for a work group: parts of them sleep ----

constexpr int k_side = 33; // boxes; 1,089 touch each other

/// Boxes side by side on the ground, a few millimetres apart, and a few on the first ones.
std::vector<BodyId> add_pavement(World& world) {
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < k_side * k_side; ++i)
        bodies.push_back(
            box_at({1.005f * static_cast<float>(i % k_side), 0.5f, 1.005f * static_cast<float>(i / k_side)}));
    return world.add(bodies);
}

Settings with_quick_sleep() {
    Settings settings = with_sleeping();
    settings.sleep_time = 0.1f;
    return settings;
}

TEST_P(Sleep, a_part_of_a_large_island_sleeps_while_others_move) {
    World world = make_world(with_quick_sleep()), awake = make_world();
    std::vector<BodyId> boxes;
    BodyId ball;
    BodyDefinition definition = sphere_at({2.3f, 1.5f, 2.0f});
    definition.velocity.linear = {2.0f, 0.0f, 0.0f};
    for (World* each : {&world, &awake}) {
        each->add(ground());
        boxes = add_pavement(*each);
        each->step(40);
        if (each == &world) {
            EXPECT_EQ(world.report().sleeping_bodies, boxes.size());
        }
        ball = each->add(definition);
    }
    std::uint32_t fewest = ~0u;
    for (int i = 0; i < 60; ++i) {
        world.step();
        fewest = std::min(fewest, world.report().sleeping_bodies);
        EXPECT_FALSE(world.is_asleep(ball)) << i;
        EXPECT_TRUE(world.is_asleep(boxes.back())) << "the far corner, " << i;
        const Vec3 at = world.pose(ball).position;
        const int x = std::clamp(static_cast<int>(std::lround(at.x / 1.005f)), 0, k_side - 1);
        EXPECT_FALSE(world.is_asleep(boxes[static_cast<std::size_t>(2 * k_side + x)])) << "the one below, " << i;
    }
    EXPECT_GT(fewest, boxes.size() - 100);
    EXPECT_LT(fewest, boxes.size());
    EXPECT_TRUE(world.is_asleep(boxes[2 * k_side + 1])) << "the ball has gone on";
    awake.step(60);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        EXPECT_LT(length(world.pose(boxes[i]).position - awake.pose(boxes[i]).position), 0.001f) << i;
    EXPECT_LT(length(world.pose(ball).position - awake.pose(ball).position), 0.1f) << "of two metres, over gaps";
}

TEST_P(Sleep, a_load_that_changes_wakes_what_carries_it_through_others) {
    World world = make_world(with_quick_sleep());
    world.add(ground());
    const std::vector<BodyId> boxes = add_pavement(world);
    std::vector<BodyId> tower{boxes[5 * k_side + 5]};
    for (int i = 1; i < 6; ++i)
        tower.push_back(world.add(box_at(world.pose(tower[0]).position + Vec3{0.0f, static_cast<float>(i), 0.0f})));
    const auto all = static_cast<std::uint32_t>(boxes.size() + tower.size() - 1);
    step_until_asleep(world, all);
    const auto press = [&](float weights) {
        world.add_force(tower[5], {0.0f, -weights * k_box_weight, 0.0f});
        world.step();
    };
    for (int i = 0; i < 20; ++i) {
        press(0.02f); // wakes the topmost and the one that it touches, which touches a third
        EXPECT_TRUE(world.is_asleep(tower[2])) << "a fiftieth of a weight is nothing to it, step " << i;
    }
    step_until_asleep(world, all);
    std::vector<bool> was_awake(tower.size());
    for (int i = 0; i < 20; ++i) {
        press(3.0f);
        for (std::size_t k = 0; k < tower.size(); ++k)
            if (!world.is_asleep(tower[k])) was_awake[k] = true;
    }
    EXPECT_EQ(was_awake, std::vector<bool>(tower.size(), true)) << "down to the ground";
    EXPECT_TRUE(world.is_asleep(boxes.back()));
    float impulse = 0.0f; // on the ground
    for (const Contact& contact : world.contacts())
        for (const ContactPoint& point : contact.points)
            if (contact.b == tower[0] && world.kind(contact.a) == BodyKind::Static) impulse += point.normal_impulse;
    const float load = 9.0f * k_box_weight / 60.0f;
    EXPECT_NEAR(impulse, load, 0.125f * load) << "what sleepers carry may differ by an eighth";
}

TEST_P(Sleep, what_loses_its_support_in_a_large_island_falls) {
    World world = make_world(with_quick_sleep());
    world.add(ground());
    const std::vector<BodyId> boxes = add_pavement(world);
    const BodyId first = boxes[5 * k_side + 5], second = boxes[5 * k_side + 6];
    const Vec3 between = (world.pose(first).position + world.pose(second).position) * 0.5f;
    const BodyId plank = world.add(box_at(between + Vec3{0.0f, 0.75f, 0.0f}, {3.0f, 0.5f, 1.0f}));
    const BodyId on_top = world.add(box_at(between + Vec3{0.0f, 1.5f, 0.0f}));
    step_until_asleep(world, static_cast<std::uint32_t>(boxes.size()) + 2);
    world.set_pose(first, {{-20.0f, 0.5f, -20.0f}, {}});
    world.set_pose(second, {{-24.0f, 0.5f, -20.0f}, {}});
    world.set_pose(boxes[5 * k_side + 4], {{-28.0f, 0.5f, -20.0f}, {}});
    world.set_pose(boxes[5 * k_side + 7], {{-32.0f, 0.5f, -20.0f}, {}});
    world.step(60);
    EXPECT_LT(world.pose(plank).position.y, 0.5f);
    EXPECT_LT(world.pose(on_top).position.y, 1.1f);
    EXPECT_TRUE(world.is_asleep(boxes.back()));
}

/// What a sleeper is weighed by, of two boxes on top of each other whose contact has all that a contact may have.
TEST(Balance, of_a_contact_both_bodies_get_the_opposite) {
    using namespace engine;
    Manifold manifold{};
    manifold.point_count = 3;
    manifold.normal = {0.6f, 0.8f, 0.0f};
    manifold.tangent_impulse_1 = 3.0f;
    manifold.tangent_impulse_2 = -2.0f;
    manifold.twist_impulse = 0.7f;
    const vec4 normal(1.0f, 2.0f, 4.0f, 99.0f); // the last is of no point
    vec3 anchors[4] = {{0.5f, 0.4f, 0.3f}, {-0.5f, 0.6f, 0.1f}, {0.2f, 0.5f, -0.4f}, {9.0f, 9.0f, 9.0f}};
    const vec3 offset(0.3f, 1.1f, -0.2f); // from A's centre to B's
    const Push a = push_of_contact(manifold, normal, anchors, vec3(0.0f), -1.0f);
    const Push b = push_of_contact(manifold, normal, anchors, offset, 1.0f);
    EXPECT_EQ(a.size, 7.0f);
    EXPECT_EQ(b.size, 7.0f);
    EXPECT_LT(glm::length(a.impulse + b.impulse), 1e-5f);
    EXPECT_NEAR(glm::dot(b.impulse, manifold.normal), 7.0f, 1e-5f) << "B is pushed along the normal";
    EXPECT_NEAR(glm::length(b.impulse), std::sqrt(49.0f + 13.0f), 1e-4f);
    EXPECT_LT(glm::length(a.moment + b.moment + glm::cross(offset, b.impulse)), 1e-4f) << "about A's centre";
    const Push still = push_of_contact(manifold, vec4(0.0f), anchors, vec3(0.0f), -1.0f);
    EXPECT_NEAR(glm::dot(still.moment, manifold.normal) + 0.7f,
                glm::dot(glm::cross((anchors[0] + anchors[1] + anchors[2]) / 3.0f, still.impulse), manifold.normal),
                1e-5f)
        << "the twist, and friction at the middle of the points";
}

TEST(Balance, a_moment_counts_by_what_it_turns) {
    using namespace engine;
    BodyProperties rod{};
    rod.inverse_inertia = {6.0f, 0.03f, 0.03f}; // 1,000 kg, 20 m long and 1 m thick
    const BodyShape box{{10.0f, 0.5f, 0.5f}, k_shape_box}, ball{{0.5f, 0.5f, 0.5f}, k_shape_sphere};
    const vec4 unturned(0.0f, 0.0f, 0.0f, 1.0f), turned(0.0f, 0.0f, std::sqrt(0.5f), std::sqrt(0.5f)); // x to y
    const auto speeds = [&](const vec3& moment, const vec4& rotation) {
        return speeds_by_moment(moment, rotation, rod, box);
    };
    EXPECT_NEAR(speeds({1.0f, 0.0f, 0.0f}, unturned).x, 6.0f * std::sqrt(0.5f), 1e-5f) << "about its length";
    EXPECT_NEAR(speeds({0.0f, 1.0f, 0.0f}, unturned).y, 0.03f * std::sqrt(100.25f), 1e-5f) << "across";
    EXPECT_NEAR(speeds({0.0f, 1.0f, 0.0f}, turned).x, 6.0f * std::sqrt(0.5f), 1e-5f) << "about its length";
    rod.inverse_inertia = vec3(10.0f);
    EXPECT_NEAR(speeds_by_moment({0.0f, 0.0f, 2.0f}, unturned, rod, ball).z, 10.0f, 1e-5f);
}

TEST(Balance, ends_beyond_an_eighth_of_the_load) {
    using namespace engine;
    for (const float gravity : {9.81f, 1.62f}) {
        for (const float dt : {1.0f / 60.0f, 1.0f / 240.0f}) {
            Settings settings;
            settings.dt = dt;
            settings.gravity = {0.0f, -gravity, 0.0f};
            const Parameters p = make_parameters(settings, {});
            const float weight = gravity * dt; // m/s
            const vec3 up(0.0f, 1.0f, 0.0f), none(0.0f);
            EXPECT_TRUE(is_balanced(up * weight, none, weight, 1.0f, p));
            EXPECT_TRUE(is_balanced(up * (0.9f * weight), none, 0.9f * weight, 1.0f, p));
            EXPECT_FALSE(is_balanced(up * (0.85f * weight), none, 0.85f * weight, 1.0f, p));
            EXPECT_FALSE(is_balanced(none, none, 0.0f, 1.0f, p)) << "it would fall";
            EXPECT_TRUE(is_balanced(none, none, 0.0f, 0.0f, p)) << "nothing pulls it";
            EXPECT_TRUE(is_balanced(up * weight, up * (0.1f * weight), weight, 1.0f, p));
            EXPECT_FALSE(is_balanced(up * weight, up * (0.15f * weight), weight, 1.0f, p));
            EXPECT_TRUE(is_balanced(up * (1.8f * weight), none, 20.0f * weight, 1.0f, p)) << "it carries ten weights";
        }
    }
    EXPECT_EQ(speed_of_balance(balance_word(-0.125f)), -0.125f);
    EXPECT_EQ(balance_word(1e30f) + balance_word(-1e30f), 0u);
    EXPECT_EQ(balance_word(std::numeric_limits<float>::quiet_NaN()), balance_word(1e30f));
}

/// On the CPU: all devices give the same bits.
World world_on_cpu(Settings settings, float dt) {
    settings.dt = dt;
    return World(settings, options_on(DeviceKind::Cpu));
}

TEST(SleepInParts, a_tower_goes_along_with_what_sinks_slowly) {
    for (const float dt : {1.0f / 60.0f, 1.0f / 240.0f}) {
        for (const float gravity : {9.81f, 1.62f}) {
            SCOPED_TRACE(testing::Message() << dt << " s, " << gravity << " m/s²");
            Settings settings = with_quick_sleep();
            settings.gravity = {0.0f, -gravity, 0.0f};
            World world = world_on_cpu(settings, dt);
            const BodyId lift = world.add(box_at({16.0f, -0.5f, 16.0f}, {60.0f, 1.0f, 60.0f}, BodyKind::Kinematic));
            const std::vector<BodyId> boxes = add_pavement(world);
            std::vector<BodyId> tower{boxes[5 * k_side + 5]};
            for (int i = 1; i < 5; ++i)
                tower.push_back(
                    world.add(box_at(world.pose(tower[0]).position + Vec3{0.0f, static_cast<float>(i), 0.0f})));
            step_until_asleep(world, static_cast<std::uint32_t>(boxes.size() + tower.size() - 1), 400);
            const float ground_before = world.pose(lift).position.y;
            std::vector<float> before;
            for (const BodyId id : tower)
                before.push_back(world.pose(id).position.y);
            world.set_velocity(lift, {{0.0f, -0.008f, 0.0f}, {}}); // slower than what rests
            world.step(static_cast<std::uint32_t>(2.0f / dt));
            const float sunk = world.pose(lift).position.y - ground_before;
            EXPECT_NEAR(sunk, -0.016f, 0.001f);
            for (std::size_t i = 0; i < tower.size(); ++i)
                EXPECT_NEAR(world.pose(tower[i]).position.y - before[i], sunk, 0.003f) << i;
        }
    }
}

TEST(SleepInParts, a_seesaw_tips_by_a_load_that_grows_as_it_would_awake) {
    for (const float dt : {1.0f / 60.0f, 1.0f / 240.0f}) {
        SCOPED_TRACE(dt);
        std::array<float, 2> tipped{}; // s
        for (const bool sleeping : {false, true}) {
            Settings settings = with_quick_sleep();
            settings.sleeping = sleeping;
            World world = world_on_cpu(settings, dt);
            world.add(ground());
            const std::vector<BodyId> boxes = add_pavement(world);
            const Vec3 top = world.pose(boxes[16 * k_side + 16]).position + Vec3{0.0f, 0.5f, 0.0f};
            world.add(box_at(top + Vec3{0.0f, 0.5f, 0.0f}));
            BodyDefinition board = box_at(top + Vec3{0.0f, 1.25f, 0.0f}, {6.0f, 0.5f, 1.0f});
            board.mass = 2000.0f;
            const BodyId plank = world.add(board);
            std::vector<BodyId> load;
            for (int i = 0; i < 2; ++i)
                load.push_back(
                    world.add(weighing(box_at(top + Vec3{2.5f, 2.0f + static_cast<float>(i), 0.0f}), 50.0f)));
            const int most = static_cast<int>(6.0f / dt);
            world.step(static_cast<std::uint32_t>(1.0f / dt));
            if (sleeping) {
                EXPECT_TRUE(world.is_asleep(plank));
            }
            int step = 0;
            for (; step < most && std::abs(world.pose(plank).rotation.z) < 0.05f; ++step) {
                const float share = 0.2f * static_cast<float>(step) * dt; // of the plank's weight
                world.add_force(load[1], {0.0f, -std::min(share, 0.8f) * 2000.0f * 9.81f, 0.0f});
                world.step();
            }
            tipped[sleeping ? 1 : 0] = static_cast<float>(step) * dt;
        }
        EXPECT_LT(tipped[0], 4.0f);
        EXPECT_NEAR(tipped[1], tipped[0], 0.3f);
    }
}

TEST_P(Sleep, parts_of_an_island_sleep_alike_on_every_device_and_after_a_snapshot) {
    const auto play = [](World& world) {
        world.add(ground());
        add_pavement(world);
        world.step(30);
        BodyDefinition ball = sphere_at({8.3f, 2.5f, 8.0f});
        ball.velocity.linear = {3.0f, 0.0f, 1.0f};
        world.add(ball);
        world.add(box_at({3.0f, 2.0f, 20.0f}));
        world.step(30);
    };
    WorldOptions options = options_on(DeviceKind::Cpu);
    options.threads = 1;
    World world = make_world(with_quick_sleep()), reference(with_quick_sleep(), options);
    play(world);
    play(reference);
    EXPECT_EQ(world.state_hash(), reference.state_hash());
    EXPECT_EQ(world.report().sleeping_bodies, reference.report().sleeping_bodies);
    EXPECT_GT(world.report().sleeping_bodies, 900u);
    EXPECT_LT(world.report().sleeping_bodies, 1089u);
    World restored = make_world();
    restored.restore(world.snapshot());
    EXPECT_EQ(restored.contacts().size(), world.contacts().size());
    for (World* each : {&world, &restored, &reference})
        each->step(30);
    EXPECT_EQ(world.state_hash(), reference.state_hash());
    EXPECT_EQ(restored.state_hash(), reference.state_hash());
}

TEST_P(Sleep, is_the_same_on_every_device) {
    for (const bool large : {false, true}) {
        for (const bool kinematic : {false, true}) {
            SCOPED_TRACE(std::string(large ? "large" : "small") + (kinematic ? ", kinematic" : ""));
            WorldOptions options = options_on(DeviceKind::Cpu);
            World reference(with_sleeping(), options), world = make_world(with_sleeping());
            EXPECT_EQ(hash_of_story(world, large, kinematic), hash_of_story(reference, large, kinematic));
        }
    }
}

TEST(SleepParity, holds_in_a_world_of_which_a_part_sleeps) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    for (const bool large : {false, true}) {
        for (const bool kinematic : {false, true}) {
            SCOPED_TRACE(std::string(large ? "large" : "small") + (kinematic ? ", kinematic" : ""));
            std::vector<BodyDefinition> bodies{ground()};
            for (int i = 0; i < 4; ++i)
                bodies.push_back(box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f}));
            bodies.push_back(sphere_at({5.0f, 12.0f, 0.0f})); // still bounces about
            bodies.push_back(box_at({5.0f, 0.5f, 0.0f}));
            if (kinematic) bodies.push_back(box_at({0.0f, 9.0f, 0.0f}, {1.0f, 1.0f, 1.0f}, BodyKind::Kinematic));
            for (int i = 0; large && i < 1030; ++i)
                bodies.push_back(box_at({3.0f * static_cast<float>(i % 32), -50.0f, 3.0f * static_cast<float>(i / 32)},
                                        {1.0f, 1.0f, 1.0f}, BodyKind::Static));
            const engine::ParityReport report = engine::compare_devices(bodies, with_sleeping(), 92);
            EXPECT_TRUE(report.integers_agree());
            EXPECT_LE(report.largest_error(), engine::k_parity_tolerance);
        }
    }
}

} // namespace
} // namespace talus::tests
