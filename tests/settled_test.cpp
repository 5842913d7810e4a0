// SPDX-License-Identifier: MIT
// What sleeps costs next to nothing: its contacts are where they were, a graph lasts while nothing is awake, and what
// sleeps as a part of a large island stands for that.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::uint;

Settings with_sleep_after(float seconds) {
    Settings settings;
    settings.sleeping = true;
    settings.sleep_time = seconds;
    return settings;
}

constexpr int k_side = 33; // boxes; 1,089 touch each other, and make a large island

/// A ground, and boxes side by side on it, a few millimetres apart.
std::vector<BodyDefinition> pavement(float gap = 0.005f) {
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < k_side * k_side; ++i)
        bodies.push_back(box_at(
            {(1.0f + gap) * static_cast<float>(i % k_side), 0.5f, (1.0f + gap) * static_cast<float>(i / k_side)}));
    return bodies;
}

class Settled : public OnDevice {
protected:
    bool on_two_devices() const { return GetParam() == DeviceKind::Hybrid; } // each hands the other what it has
};
TALUS_ON_EVERY_DEVICE(Settled);

TEST_P(Settled, contacts_are_not_written_again) {
    EngineRun run(options_on(GetParam()), pavement(), with_sleep_after(0.1f));
    run.step(40);
    ASSERT_EQ(run.counter(engine::k_counter_sleeping_bodies), k_side * k_side);
    const std::vector<engine::Manifold> before = run.manifolds();
    for (int i = 0; i < 4; ++i) {
        run.step();
        const std::vector<engine::Manifold> now = run.manifolds();
        ASSERT_EQ(now.size(), before.size());
        EXPECT_EQ(std::memcmp(now.data(), before.data(), now.size() * sizeof now[0]), 0) << i;
    }
    if (!on_two_devices()) {
        EXPECT_EQ(run.counter(engine::k_counter_pairs_to_collide), 0u);
    }
    run.simulation.search_anew(); // pairs get new places
    run.step();
    EXPECT_EQ(run.counter(engine::k_counter_sleeping_bodies), k_side * k_side);
    run.step();
    run.step();
    const auto by_bodies = [](const engine::Manifold& a, const engine::Manifold& b) {
        return std::pair{a.body_a, a.body_b} < std::pair{b.body_a, b.body_b};
    };
    std::vector<engine::Manifold> expected = before, now = run.manifolds();
    for (std::vector<engine::Manifold>* each : {&expected, &now}) {
        std::ranges::sort(*each, by_bodies);
        for (engine::Manifold& manifold : *each) // a search forgets how far apart bodies are
            if (manifold.point_count == 0) manifold.weights = 0.0f;
    }
    ASSERT_EQ(now.size(), expected.size());
    EXPECT_EQ(std::memcmp(now.data(), expected.data(), now.size() * sizeof now[0]), 0);
}

TEST_P(Settled, contacts_lie_where_they_were_two_steps_ago) {
    if (on_two_devices()) return;
    EngineRun run(options_on(GetParam()), pavement(), with_sleep_after(0.1f));
    run.step(60);
    ASSERT_EQ(run.counter(engine::k_counter_sleeping_bodies), k_side * k_side);
    std::vector<engine::Manifold> marked = run.manifolds();
    const float friction = marked[0].friction, mark = 0.123f;
    marked[0].friction = mark; // in one of the two places; nothing sets it right as long as it is left alone
    run.simulation.write(BufferId::OldManifolds, 0, std::span<const engine::Manifold>(marked));
    run.step();
    EXPECT_EQ(run.manifolds()[0].friction, friction);
    run.step();
    EXPECT_EQ(run.manifolds()[0].friction, mark);
    run.step();
    EXPECT_EQ(run.manifolds()[0].friction, friction);
}

TEST_P(Settled, no_graph_is_made_while_nothing_is_awake) {
    for (const bool large : {false, true}) {
        SCOPED_TRACE(large ? "large world" : "small world");
        World world = make_world(with_sleep_after(0.1f));
        std::vector<BodyDefinition> bodies = large ? pavement(0.5f) : std::vector{ground()};
        bodies.push_back(box_at({-5.0f, 0.5f, 0.0f}));
        bodies.push_back(box_at({-5.0f, 1.5f, 0.0f}));
        const std::vector<BodyId> ids = world.add(bodies);
        world.step(72);
        const StepReport asleep = world.report();
        EXPECT_EQ(asleep.sleeping_bodies, bodies.size() - 1);
        EXPECT_EQ(asleep.manifolds, bodies.size() - 1);
        EXPECT_EQ(asleep.contacts, 4 * (bodies.size() - 1));
        world.add_force(ids.back(), {0.0f, -1.0f, 0.0f});
        world.step();
        EXPECT_FALSE(world.is_asleep(ids.back()));
        if (!on_two_devices()) {
            EXPECT_GE(world.report().dispatches, asleep.dispatches + 5) << "two for waking, and those of a graph";
        }
        EXPECT_FALSE(world.is_asleep(ids[ids.size() - 2])) << "it is of the same island";
        EXPECT_EQ(world.report().sleeping_bodies, bodies.size() - 3);
        EXPECT_EQ(world.report().manifolds, bodies.size() - 1);
        EXPECT_EQ(world.report().contacts, 4 * (bodies.size() - 1));
        world.step(60);
        EXPECT_EQ(world.report().sleeping_bodies, bodies.size() - 1);
    }
}

TEST_P(Settled, what_wakes_all_at_once_has_room_for_its_constraints) {
    std::vector<BodyDefinition> bodies = pavement(0.5f); // each box sleeps by itself
    BodyDefinition plate = box_at({24.0f, 2.6f, 24.0f}, {60.0f, 0.2f, 60.0f});
    plate.density = 10.0f;
    bodies.push_back(plate);
    WorldOptions serial = options_on(DeviceKind::Cpu);
    serial.threads = 1;
    EngineRun run(options_on(GetParam()), bodies, with_sleep_after(0.1f)),
        expected(serial, bodies, with_sleep_after(0.1f));
    const auto sleepers = [&] { return run.counter(engine::k_counter_sleeping_bodies); };
    const auto step_both = [&](uint count) {
        run.step(count);
        expected.step(count);
    };
    step_both(25);
    ASSERT_EQ(sleepers(), k_side * k_side);
    for (int i = 0; i < 60 && sleepers() > 0; ++i) // until the plate has come down
        step_both(1);
    EXPECT_EQ(sleepers(), 0u);
    EXPECT_GT(run.counter(engine::k_counter_manifold_count), 2000u);
    const uint growths = run.simulation.report().growths;
    for (int i = 0; i < 3; ++i) {
        step_both(4);
        EXPECT_TRUE(run.motion() == expected.motion()) << i;
    }
    EXPECT_EQ(run.simulation.report().growths, growths);
}

TEST_P(Settled, what_is_awake_beside_a_part_has_the_sub_steps_of_the_whole_island) {
    std::vector<BodyDefinition> bodies = pavement();
    BodyDefinition heavy = box_at({0.0f, 1.5f, 0.0f});
    heavy.density = 400'000.0f;
    bodies.push_back(heavy);
    BodyDefinition ball = sphere_at({26.0f, 1.5f, 30.0f});
    ball.velocity.linear = {0.15f, 0.0f, 0.0f};
    bodies.push_back(ball);
    EngineRun run(options_on(GetParam()), bodies, with_sleep_after(0.5f));
    run.step(200);
    EXPECT_GT(run.counter(engine::k_counter_sleeping_bodies), 1050u);
    uint most = 0, at_ball = 0;
    const uint ball_slot = static_cast<uint>(bodies.size()) - 1;
    for (const engine::Manifold& manifold : run.manifolds()) {
        if (manifold.point_count == 0) continue;
        most = std::max(most, engine::substeps_of(manifold.demand));
        if (manifold.body_b == ball_slot) at_ball = std::max(at_ball, engine::substeps_of(manifold.demand));
    }
    EXPECT_GT(most, at_ball) << "the heavy box asks for more";
    const auto inertias = run.read<engine::BodyInertia>(BufferId::Inertias, bodies.size());
    EXPECT_EQ(inertias[ball_slot].substeps, most);
}

TEST_P(Settled, a_part_of_what_has_become_a_small_island_wakes_with_it) {
    World world = make_world(with_sleep_after(0.1f));
    const std::vector<BodyId> ids = world.add(pavement());
    world.step(40);
    ASSERT_EQ(world.report().sleeping_bodies, k_side * k_side);
    std::vector<BodyDefinition> ballast; // so that it stays a large world
    for (int i = 6 * k_side; i < k_side * k_side; ++i) {
        world.remove(ids[static_cast<std::size_t>(1 + i)]);
        ballast.push_back(box_at({3.0f * static_cast<float>(i % 32), -50.0f, 3.0f * static_cast<float>(i / 32)},
                                 {1.0f, 1.0f, 1.0f}, BodyKind::Static));
    }
    world.add(ballast);
    world.step(60);
    EXPECT_EQ(world.report().sleeping_bodies, 6 * k_side) << "six rows are left";
    world.add_force(ids[1], {1.0f, 0.0f, 0.0f});
    world.step();
    EXPECT_EQ(world.report().sleeping_bodies, 0u) << "it is a small island now";
}

TEST_P(Settled, few_pairs_have_room_for_their_marks) {
    WorldOptions options = options_on(GetParam());
    options.capacities.pairs = 1;
    World world(with_sleep_after(0.1f), options);
    std::vector<BodyDefinition> bodies{ground(), box_at({0.0f, 0.5f, 0.0f})};
    for (int i = 0; i < 1100; ++i) {
        bodies.push_back(sphere_at({2.0f * static_cast<float>(i % 32), -50.0f, 2.0f * static_cast<float>(i / 32)}));
        bodies.back().kind = BodyKind::Static;
    }
    world.add(bodies);
    world.step(40);
    EXPECT_EQ(world.report().pairs, 1u);
    EXPECT_EQ(world.report().sleeping_bodies, 1u);
}

TEST_P(Settled, a_watch_that_begins_changes_nothing) {
    World watched = make_world(with_sleep_after(0.1f)), other = make_world(with_sleep_after(0.1f));
    for (World* world : {&watched, &other}) {
        world->add(pavement());
        world->step(40);
        world->add(box_at({8.3f, 1.8f, 8.0f})); // keeps some awake, who press others
        world->step(14);
    }
    watched.watch_contacts(ContactWatch::All); // more reports than a GPU has room for at first
    for (int i = 0; i < 6; ++i) {
        watched.step();
        other.step();
        EXPECT_EQ(watched.report().sleeping_bodies, other.report().sleeping_bodies) << i;
        EXPECT_EQ(watched.state_hash(), other.state_hash()) << i;
    }
    EXPECT_LT(other.report().sleeping_bodies, k_side * k_side + 1);
}

TEST_P(Settled, nothing_is_done_anew_for_who_draws) {
    if (GetParam() == DeviceKind::Cpu || on_two_devices())
        return; // there is nothing to draw from, or each step makes a graph
    World world = make_world(with_sleep_after(0.1f));
    world.add(pavement(0.5f));
    world.step(140);
    const std::uint32_t before = world.report().dispatches;
    for (int i = 0; i < 4; ++i) {
        world.gl_buffers();
        world.step();
        world.poses(); // waits
    }
    EXPECT_EQ(world.report().dispatches, before);
}

TEST(KeptIsland, says_of_a_sleeper_what_its_island_asked_for) {
    using namespace engine;
    const uint least = 5000;
    const auto keep = [&](uint size, uint parts, bool may_be_multirate) {
        return keep_island(island_at_rest(size, parts, least, may_be_multirate), 9, 24);
    };
    EXPECT_FALSE(island_at_rest(1024, 0, least, true).in_parts);
    EXPECT_TRUE(island_at_rest(1025, 0, least, true).in_parts);
    EXPECT_TRUE(island_at_rest(3, parts_said(keep(1025, 0, true)), least, true).in_parts) << "a part is of it";
    EXPECT_EQ(own_substeps_kept(keep(2000, 0, true)), 9u);
    EXPECT_EQ(substeps_kept(keep(2000, 0, true)), 24u);
    EXPECT_EQ(substeps_kept(keep(6000, 0, true)), 9u) << "there each contact has its own";
    EXPECT_EQ(substeps_kept(keep(6000, 0, false)), 24u);
    EXPECT_EQ(parts_said(keep(2000, 0, true)), k_has_part);
    EXPECT_EQ(parts_said(keep(6000, 0, false)), k_has_part | k_has_many);
    EXPECT_EQ(parts_said(keep(3, k_has_part | k_has_many, true)), k_has_part | k_has_many) << "it stays so";
    EXPECT_TRUE(island_at_rest(3, k_has_part | k_has_many, least, true).multirate);
    EXPECT_FALSE(island_at_rest(2000 | (5u << k_foot_rate_shift), 0, least, true).many) << "no rate is a size";
    Parameters p{};
    p.rest_steps = 1000;
    EXPECT_TRUE(is_calm(with_calm({}, keep(2000, 0, true)), p)) << "for however long";
}

TEST(KeptIsland, ends_when_a_body_wakes) {
    using namespace engine;
    BodyPose pose{};
    pose.flags = k_body_asleep | k_body_in_part | k_body_settled | (7u << k_rest_shift);
    EXPECT_TRUE(is_quiet_part(pose));
    EXPECT_TRUE(is_settled(pose));
    pose.flags |= k_body_disturbed;
    EXPECT_FALSE(is_quiet_part(pose));
    EXPECT_FALSE(is_settled(pose));
    EXPECT_EQ(wake_flags(pose.flags), k_body_disturbed);
}

} // namespace
} // namespace talus::tests
