// SPDX-License-Identifier: MIT
// Contacts as one wants them, on every device: rest is rest, a floor of many boxes is as smooth as one, walls stop what
// is fast, overlap is undone gently, the heavy may stand on the light.
#include <string>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

class ContactQuality : public OnDevice {};
class LongContactQuality : public OnDevice {};

// ---- rest ----

TEST_P(ContactQuality, a_stack_of_ten_stands) {
    World world = make_world();
    world.add(bodies_of("stack:height=10"));
    const std::vector<Pose> start = world.poses();
    world.step(300);
    const std::vector<Pose> end = world.poses();
    for (std::size_t i = 0; i < start.size(); ++i) {
        EXPECT_LT(length(end[i].position - start[i].position), 0.05f) << "box " << i;
        EXPECT_NEAR(std::abs(end[i].rotation.w), 1.0f, 1e-4f) << "box " << i;
    }
    EXPECT_LT(largest_speed(world), 0.02f);
}

TEST_P(ContactQuality, baumgarte_holds_a_stack_too) {
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

/// After some seconds, two more: nothing moves by `farthest` (m), nor faster than `fastest` (m/s, and rad/s).
void expect_stillness(World& world, std::uint32_t seconds = 10, float fastest = 1e-3f, float farthest = 1e-4f) {
    world.step(60 * seconds);
    const std::vector<Pose> before = world.poses();
    for (int i = 0; i < 120; ++i) {
        world.step();
        const std::vector<Velocity> velocities = world.velocities();
        for (std::size_t k = 0; k < velocities.size(); ++k) {
            EXPECT_LT(length(velocities[k].linear), fastest) << "body " << k << ", step " << world.step_count();
            EXPECT_LT(length(velocities[k].angular), fastest) << "body " << k << ", step " << world.step_count();
        }
        if (testing::Test::HasFailure()) return; // one step's words are enough
    }
    const std::vector<Pose> after = world.poses();
    for (std::size_t k = 0; k < after.size(); ++k)
        EXPECT_LT(length(after[k].position - before[k].position), farthest) << "body " << k;
}

TEST_P(LongContactQuality, a_stack_at_rest_is_still) {
    World world = make_world();
    world.add(bodies_of("stack:height=10"));
    expect_stillness(world);
}

TEST_P(LongContactQuality, a_stack_of_turned_boxes_at_rest_is_still) {
    World world = make_world();
    world.add(ground());
    for (int i = 0; i < 6; ++i) {
        BodyDefinition box = box_at({0.03f * static_cast<float>(i % 3), 0.5f + static_cast<float>(i), 0.0f});
        box.pose.rotation = turn({0.0f, 1.0f, 0.0f}, 0.5f * static_cast<float>(i));
        world.add(box);
    }
    expect_stillness(world);
}

/// A light box between a heavy one and the ground is pushed by both in turns, and must not go round.
TEST_P(LongContactQuality, a_box_that_has_fallen_on_a_lighter_one_comes_to_rest) {
    World world = make_world();
    world.add(ground());
    float x = 0.0f;
    for (const float ratio : {3.0f, 10.0f, 100.0f}) {
        world.add(box_at({x, 0.5f, 0.0f}));
        world.add(weighing(box_at({x + 0.05f, 1.6f, 0.03f}), 1000.0f * ratio));
        x += 3.0f;
    }
    expect_stillness(world, 20);
}

/// The contacts with those beside it are there before the one with the ground, which must be solved after them all the
/// same.
TEST_P(LongContactQuality, a_light_box_that_falls_among_others_under_a_heavy_one_comes_to_rest) {
    World world = make_world();
    world.add(ground());
    float x = 0.0f;
    for (const float ratio : {10.0f, 100.0f}) {
        world.add(crowded_box(x, 1000.0f * ratio));
        x += 6.0f;
    }
    expect_stillness(world, 20);
}

TEST_P(LongContactQuality, a_wall_at_rest_is_still) {
    // Where all bricks are solved in the same order, and with one sweep over a manifold's points, it sways.
    World world = make_world();
    world.add(bodies_of("wall:width=20,height=20"));
    // How fast it still sways after ten seconds is chance, and the last bits decide: eight runs with steps that were
    // shorter or longer by up to 0.05 % had 0.1 to 0.7 mm/s at four instants, of the version before 0.3 to 1.0, and
    // this one has 1.1 once. So is how far it comes in two seconds: five runs with steps that were shorter or longer by
    // up to 0.02 % had 0.007 to 0.20 mm in twelve such spans each, of the version before 0.013 to 0.25 mm.
    expect_stillness(world, 10, 2e-3f, 4e-4f);
}

TEST_P(LongContactQuality, a_pyramid_at_rest_is_still) {
    World world = make_world();
    world.add(bodies_of("pyramid:base=8"));
    expect_stillness(world);
}

TEST_P(LongContactQuality, boxes_that_have_fallen_come_to_rest) {
    World world = make_world();
    world.add(ground());
    for (int i = 0; i < 5; ++i) {
        BodyDefinition box = box_at({0.2f * static_cast<float>(i % 2), 1.0f + 1.3f * static_cast<float>(i), 0.0f});
        box.pose.rotation = turn({0.6f, 0.0f, 0.8f}, 0.1f * static_cast<float>(i));
        world.add(box);
    }
    expect_stillness(world, 16); // they land as a tower, which rocks for thirteen
}

// ---- a floor of many boxes ----

enum class Floor { One, Tiles, FineTiles };

/// A slide over a floor with its upper side at y = 0: the speed and the height after each step.
struct Slide {
    std::vector<float> speed, rise, tilt;
    float distance = 0.0f;
};

Slide slide_over(World& world, Floor floor, BodyDefinition body, float friction, float start_speed = 6.0f) {
    if (floor == Floor::One) {
        world.add(with_material(box_at({10.0f, -0.5f, 0.0f}, {30.0f, 1.0f, 6.0f}, BodyKind::Static), friction));
    } else {
        const float edge = floor == Floor::Tiles ? 1.0f : 0.25f;
        for (float x = -2.5f; x < 18.0f; x += edge)
            for (float z = -1.0f; z < 1.01f; z += 1.0f)
                world.add(with_material(box_at({x, -0.5f, z}, {edge, 1.0f, 1.0f}, BodyKind::Static), friction));
    }
    body.velocity.linear = {start_speed, 0.0f, 0.0f};
    const BodyId id = world.add(with_material(body, friction));
    world.step(5); // settle
    Slide slide;
    for (int i = 0; i < 120; ++i) {
        world.step();
        const Velocity velocity = world.velocity(id);
        slide.speed.push_back(velocity.linear.x);
        slide.rise.push_back(velocity.linear.y);
        slide.tilt.push_back(std::hypot(velocity.angular.x, velocity.angular.z));
    }
    slide.distance = world.pose(id).position.x;
    return slide;
}

TEST_P(ContactQuality, a_floor_of_many_boxes_is_as_smooth_as_one) {
    for (const float yaw : {0.0f, 0.3f}) {
        for (const float friction : {0.0f, 0.3f}) {
            for (const Floor floor : {Floor::Tiles, Floor::FineTiles}) {
                SCOPED_TRACE("yaw " + std::to_string(yaw) + ", friction " + std::to_string(friction) +
                             (floor == Floor::Tiles ? ", tiles of 1 m" : ", tiles of 25 cm"));
                BodyDefinition body = box_at({0.0f, 0.3f, 0.05f}, {0.8f, 0.6f, 0.8f});
                body.pose.rotation = turn({0.0f, 1.0f, 0.0f}, yaw);
                World smooth_world = make_world(), tiled_world = make_world();
                const Slide smooth = slide_over(smooth_world, Floor::One, body, friction);
                const Slide tiled = slide_over(tiled_world, floor, body, friction);
                float slower = 0.0f, bump = 0.0f, tilt = 0.0f;
                for (std::size_t i = 0; i < smooth.speed.size(); ++i) {
                    slower = std::max(slower, std::abs(tiled.speed[i] - smooth.speed[i]));
                    bump = std::max(bump, std::abs(tiled.rise[i] - smooth.rise[i]));
                    tilt = std::max(tilt, std::abs(tiled.tilt[i] - smooth.tilt[i]));
                }
                EXPECT_LT(slower, 0.01f * 6.0f);
                EXPECT_LT(bump, 0.01f) << "m/s, up or down";
                EXPECT_LT(tilt, 0.02f) << "rad/s";
                EXPECT_NEAR(tiled.distance, smooth.distance, 0.01f * smooth.distance);
            }
        }
    }
}

TEST_P(LongContactQuality, a_slow_box_does_not_stick_between_the_boxes_of_a_floor) {
    for (const float speed : {0.5f, 1.0f, 2.0f, 3.0f}) {
        SCOPED_TRACE(speed);
        World world = make_world();
        const Slide slide =
            slide_over(world, Floor::FineTiles, box_at({0.0f, 0.3f, 0.05f}, {0.8f, 0.6f, 0.8f}), 0.0f, speed);
        EXPECT_NEAR(slide.distance, speed * 125.0f * k_dt, 0.01f * speed * 125.0f * k_dt);
        for (std::size_t i = 0; i < slide.speed.size(); ++i)
            EXPECT_LT(std::abs(slide.rise[i]), 0.01f) << i;
    }
}

TEST_P(ContactQuality, a_ball_rolls_over_a_floor_of_many_boxes) {
    World world = make_world();
    const Slide slide = slide_over(world, Floor::Tiles, sphere_at({0.0f, 0.4f, 0.05f}, 0.4f), 0.0f);
    for (std::size_t i = 0; i < slide.speed.size(); ++i) {
        EXPECT_NEAR(slide.speed[i], 6.0f, 0.01f * 6.0f) << i;
        EXPECT_LT(std::abs(slide.rise[i]), 0.01f) << i;
    }
}

// ---- speed ----

TEST_P(ContactQuality, a_wall_stops_a_fast_box) {
    struct Shot {
        const char* name;
        Vec3 size, spin;
    };
    const Shot shots[] = {
        {"a box of 1 m", {1.0f, 1.0f, 1.0f}, {}},
        {"a box of 20 cm", {0.2f, 0.2f, 0.2f}, {}},
        {"a spinning box of 20 cm", {0.2f, 0.2f, 0.2f}, {20.0f, 30.0f, 40.0f}},
        {"a spinning box of 1 m", {1.0f, 1.0f, 1.0f}, {5.0f, 20.0f, -15.0f}},
        {"a whirling rod", {1.0f, 0.1f, 0.1f}, {0.0f, 30.0f, 60.0f}},
    };
    for (const Shot& shot : shots) {
        // Phases: how far from the wall the last step before the impact ends.
        for (int phase = 0; phase < 8; ++phase) {
            const float start = -10.0f - 0.2083f * static_cast<float>(phase);
            SCOPED_TRACE(std::string(shot.name) + " from " + std::to_string(start));
            World world = make_world(weightless());
            world.add(box_at({0.25f, 0.0f, 0.0f}, {0.5f, 20.0f, 20.0f}, BodyKind::Static));
            BodyDefinition box = box_at({start, 0.3f, 0.2f}, shot.size);
            box.velocity = {{100.0f, 0.0f, 0.0f}, shot.spin};
            const BodyId id = world.add(box);
            for (int i = 0; i < 30; ++i) {
                world.step();
                ASSERT_LT(world.pose(id).position.x, 0.0f) << "its centre is in the wall in step " << i;
            }
            EXPECT_LT(world.velocity(id).linear.x, 1.0f) << "it has been stopped";
        }
    }
}

// ---- overlap ----

TEST_P(ContactQuality, overlapping_boxes_part_without_a_leap) {
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

TEST_P(ContactQuality, deep_overlap_is_undone_at_no_more_than_the_push_speed) {
    for (const float apart : {0.1f, 0.5f, 0.8f}) {
        SCOPED_TRACE(apart);
        World world = make_world(weightless());
        const BodyId a = world.add(box_at({0.0f, 0.0f, 0.0f})), b = world.add(box_at({apart, 0.1f, 0.05f}));
        const float push = world.settings().contact_push_speed;
        float before = apart;
        for (int i = 0; i < 120; ++i) {
            world.step();
            const float distance = world.pose(b).position.x - world.pose(a).position.x;
            EXPECT_LT((distance - before) / k_dt, 1.01f * push) << "step " << i;
            before = distance;
        }
        EXPECT_GT(before, 0.98f) << "apart";
        EXPECT_LT(largest_speed(world), 0.1f * push) << "and not flying";
    }
}

TEST_P(ContactQuality, a_heap_of_overlapping_boxes_does_not_explode) {
    World world = make_world();
    world.add(ground());
    for (int i = 0; i < 27; ++i)
        world.add(box_at({0.6f * static_cast<float>(i % 3), 0.5f + 0.6f * static_cast<float>(i / 9),
                          0.6f * static_cast<float>(i / 3 % 3)}));
    // Each layer is pushed off the one below, so the top one at twice the push speed, and sideways besides: up to 9 m/s
    // are seen (solver.md).
    const float fastest = 3.5f * world.settings().contact_push_speed;
    for (int i = 0; i < 240; ++i) {
        world.step();
        ASSERT_LT(largest_speed(world), fastest) << "step " << i;
    }
    for (const Pose& pose : world.poses())
        EXPECT_LT(pose.position.y, 3.0f);
    // Of 400 such heaps, each a little different, in seven a box fell yet after 4 s, and in none after 8.
    world.step(240);
    EXPECT_LT(largest_speed(world), 0.5f);
}

// ---- heavy on light ----

TEST_P(LongContactQuality, the_heavy_may_stand_on_the_light) {
    for (const float ratio : {100.0f, 1000.0f}) {
        for (const int light : {1, 3}) {
            SCOPED_TRACE("1:" + std::to_string(static_cast<int>(ratio)) + " on " + std::to_string(light));
            World world = make_world();
            world.add(ground());
            std::vector<BodyId> boxes;
            for (int i = 0; i < light; ++i)
                boxes.push_back(world.add(box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f})));
            BodyDefinition load = box_at({0.0f, 0.5f + static_cast<float>(light), 0.0f});
            load.density = 1000.0f * ratio;
            boxes.push_back(world.add(load));
            world.step(600);
            float below = -0.5f;
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                const Vec3 position = world.pose(boxes[i]).position;
                EXPECT_LT(1.0f - (position.y - below), 0.02f) << "overlap below box " << i << ", m";
                EXPECT_LT(std::hypot(position.x, position.z), 0.02f) << "box " << i;
                below = position.y;
            }
            EXPECT_LT(largest_speed(world), 0.01f);
        }
    }
}

// ---- columns ----

/// Bodies in the order of the tower, and others that only lie on it.
struct Tower {
    std::vector<BodyDefinition> bodies{ground()}, others;
};

/// Storeys of four boxes and of one by turns, each with a slab on it: the loads of four contacts come together in one.
Tower tower_that_joins() {
    Tower tower;
    float y = 0.0f;
    for (int storey = 0; storey < 40; ++storey) {
        if (storey % 2 == 0) {
            for (const float x : {-0.6f, 0.6f})
                for (const float z : {-0.6f, 0.6f})
                    tower.bodies.push_back(weighing(box_at({x, y + 0.5f, z}, {1.0f, 1.0f, 1.0f}), 1000.0f));
        } else {
            tower.bodies.push_back(weighing(box_at({0.0f, y + 0.5f, 0.0f}, {1.0f, 1.0f, 1.0f}), 1000.0f));
        }
        tower.bodies.push_back(weighing(box_at({0.0f, y + 1.25f, 0.0f}, {2.2f, 0.5f, 2.2f}), 1000.0f));
        y += 1.5f;
    }
    return tower;
}

/// A tower with ledges. On each lies a stone of 100 g, heavily loaded by one of 7 kg: 70 weights, as at the tower's
/// foot.
Tower tower_with_stones() {
    Tower tower;
    for (int i = 0; i < 60; ++i) {
        const float y = static_cast<float>(i);
        tower.bodies.push_back(
            weighing(box_at({0.0f, y + 0.5f, 0.0f}, {i % 2 == 0 ? 1.0f : 2.0f, 1.0f, 1.0f}), 1000.0f));
        for (const float x : {-0.75f, 0.75f}) {
            if (i % 2 == 0) continue;
            tower.others.push_back(weighing(box_at({x, y + 1.1f, 0.0f}, {0.2f, 0.2f, 0.2f}), 0.1f));
            tower.others.push_back(weighing(box_at({x, y + 1.3f, 0.0f}, {0.2f, 0.2f, 0.2f}), 7.0f));
        }
    }
    return tower;
}

/// Sub-steps are those that so high a tower needs, once the trial is over, in which it has the most anyway.
void expect_to_stand(const Tower& tower, std::uint32_t least_substeps) {
    World world({}, options_on(DeviceKind::Cpu));
    const std::vector<BodyId> boxes = world.add(tower.bodies);
    world.add(tower.others);
    const std::vector<Pose> start = world.poses();
    world.step(600);
    const std::vector<Pose> end = world.poses();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Vec3 drift = end[i].position - start[i].position;
        EXPECT_LT(length(drift), 0.02f) << "box " << i;
        EXPECT_LT(std::hypot(drift.x, drift.z), 0.001f) << "box " << i;
    }
    EXPECT_GE(world.report().substeps, least_substeps);
}

TEST(Columns, stand_where_the_loads_of_several_contacts_come_together) {
    expect_to_stand(tower_that_joins(), 96);
}

TEST(Columns, stand_whatever_heavily_loaded_trifles_lie_on_them) {
    expect_to_stand(tower_with_stones(), 48);
}

/// Its one contact is as heavily loaded as that below a tower of 31, which needs 24 sub-steps, and cannot buckle.
TEST(Columns, of_a_single_contact_need_few_substeps) {
    World world({}, options_on(DeviceKind::Cpu));
    world.add(std::vector{ground(), weighing(box_at({0.0f, 0.5f, 0.0f}, {1.0f, 1.0f, 1.0f}), 1000.0f),
                          weighing(box_at({0.0f, 2.0f, 0.0f}, {2.0f, 2.0f, 2.0f}), 30e3f)});
    world.step(600);
    EXPECT_LE(world.report().substeps, 16u);
    EXPECT_LT(largest_speed(world), 1e-3f);
}

// A gap as wide as where contacts begin would have one come and go for ever, by micrometres.
TEST_P(ContactQuality, contacts_end_farther_away_than_they_begin) {
    Settings settings;
    settings.gravity = {};
    World world = make_world(settings);
    world.add(ground());
    const BodyId box = world.add(box_at({0.0f, 0.5118f, 0.0f}));
    const float way = 1.0e-4f; // m, of a step
    const auto gap = [&] { return world.pose(box).position.y - 0.5f; };
    float last_with = 0.0f, first_with = 0.0f;
    world.set_velocity(box, {{0.0f, 60.0f * way, 0.0f}, {}});
    for (int i = 0; i < 10; ++i) {
        const float before = gap();
        world.step();
        if (!world.contacts().empty()) last_with = before;
    }
    EXPECT_GT(last_with, 0.01225f);
    EXPECT_LT(last_with, 0.01225f + 2.0f * way) << "it reaches as far ahead as the box moves, too";
    EXPECT_GT(gap(), last_with + 2.0f * way);
    world.set_velocity(box, {{0.0f, -60.0f * way, 0.0f}, {}});
    for (int i = 0; i < 10 && first_with == 0.0f; ++i) {
        const float before = gap();
        world.step();
        if (!world.contacts().empty()) first_with = before;
    }
    EXPECT_GT(first_with, 0.0119f);
    EXPECT_LT(first_with, 0.01202f + way);
}

TALUS_ON_EVERY_DEVICE(ContactQuality);
TALUS_ON_THE_CPU(LongContactQuality);

} // namespace
} // namespace talus::tests
