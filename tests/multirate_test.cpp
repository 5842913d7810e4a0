// SPDX-License-Identifier: MIT
// Islands whose contacts differ in sub-steps (resolution/multirate.shared.glsl). They have tens of thousands of bodies
// where nobody asks for less, so that these tests do.
#include <cmath>

#include <gtest/gtest.h>

#include "scenes/scene.h"
#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::uint;

Settings eight_at_most() {
    Settings settings;
    settings.substeps = 2; // renderers in software end long loops
    settings.max_substeps = 8;
    return settings;
}

/// After a step: lets the contacts ask for 2, 4 or 8 sub-steps, by turns, as those of low columns, and some stand on a
/// foot.
void ask_for_different_substeps(EngineRun& run) {
    std::vector<engine::Manifold> manifolds = run.manifolds();
    for (std::size_t i = 0; i < manifolds.size(); ++i)
        manifolds[i].demand = engine::make_demand(i % 7 == 0 ? 8 : i % 3 == 0 ? 4 : 2, 0, i % 11 == 0 ? i % 4 : 0, 1);
    run.simulation.write(BufferId::OldManifolds, 0, std::span<const engine::Manifold>(manifolds));
    const uint due = 1;
    run.simulation.write(BufferId::Counters, engine::k_counter_graph_due, std::span(&due, 1));
}

/// A wall with more bodies than a work group solves.
std::vector<BodyDefinition> long_wall(int boxes_a_row = 190) {
    std::vector<BodyDefinition> bodies{ground()};
    for (int row = 0; row < 6; ++row)
        for (int i = 0; i < boxes_a_row; ++i)
            bodies.push_back(box_at({1.001f * static_cast<float>(i) + 0.5f * static_cast<float>(row % 2),
                                     0.5f + static_cast<float>(row), 0.0f}));
    return bodies;
}

/// The tower's boxes come first, from the lowest up.
std::vector<BodyDefinition> tower_in_large_world(uint height) {
    std::vector<BodyDefinition> bodies{ground()};
    for (uint i = 0; i < height; ++i)
        bodies.push_back(box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f}));
    for (int i = 0; i < 1030; ++i)
        bodies.push_back(box_at({5.0f + 2.0f * static_cast<float>(i % 40), 0.5f, 2.0f * static_cast<float>(i / 40)}));
    return bodies;
}

struct Contacts {
    uint slow = 0, fast = 0,
         beside_faster = 0; ///< beside_faster: one of the bodies has more sub-steps than the contact
};

Contacts count_contacts(const EngineRun& run) {
    const auto constraints =
        run.read<engine::ContactConstraint>(BufferId::Constraints, run.counter(engine::k_counter_manifold_count));
    const auto inertias = run.read<engine::BodyInertia>(BufferId::Inertias, run.table.slot_count());
    Contacts contacts;
    for (const engine::ContactConstraint& c : constraints) {
        ++(engine::substeps_of_contact(c.counts) == 2 ? contacts.slow : contacts.fast);
        const bool is_faster =
            std::max(inertias[c.body_a].substeps, inertias[c.body_b].substeps) > engine::substeps_of_contact(c.counts);
        contacts.beside_faster += engine::is_multirate(c.traits) && is_faster ? 1 : 0;
    }
    return contacts;
}

/// Contacts that ask for so many, which of new ones is not known yet.
uint count_asking(const EngineRun& run, uint substeps) {
    uint count = 0;
    for (const engine::Manifold& manifold : run.manifolds())
        count += manifold.point_count > 0 && engine::substeps_of(manifold.demand) == substeps ? 1 : 0;
    return count;
}

TEST(Multirate, numbers_are_doubles_of_the_fewest) {
    Settings settings;
    settings.substeps = 5;
    settings.max_substeps = 32;
    const engine::StepPlan plan{.least_substeps = 5, .most_substeps = 32};
    const engine::Parameters p = engine::make_parameters(settings, plan);
    EXPECT_EQ(engine::doubled_substeps(0, p), 5u);
    EXPECT_EQ(engine::doubled_substeps(5, p), 5u);
    EXPECT_EQ(engine::doubled_substeps(6, p), 10u);
    EXPECT_EQ(engine::doubled_substeps(11, p), 20u);
    EXPECT_EQ(engine::doubled_substeps(32, p), 20u) << "40 would be more than the most";
}

TEST(Multirate, contacts_may_have_half_of_the_least_number_of_an_island) {
    engine::StepPlan plan{.least_substeps = 8, .most_substeps = 32};
    EXPECT_EQ(plan.fewest_substeps(), 8u) << "no island of so few bodies is multirate";
    plan.body_count = 100'000;
    plan.small = false;
    plan.one_island = false;
    EXPECT_EQ(plan.fewest_substeps(), 4u);
    EXPECT_EQ(engine::doubled_substeps(3, engine::make_parameters({}, plan)), 4u);
    EXPECT_EQ(engine::multirate_substeps(3, 0, false, engine::make_parameters({}, plan)), 4u);
    EXPECT_EQ(engine::multirate_substeps(3, 0, true, engine::make_parameters({}, plan)), 8u) << "beside a tall column";
    EXPECT_EQ(engine::multirate_substeps(3, 2, true, engine::make_parameters({}, plan)), 16u) << "by its foot";
    plan.sleeping = true;
    EXPECT_EQ(plan.fewest_substeps(), 8u);
    plan.sleeping = false;
    plan.least_substeps = plan.most_substeps = 8;
    EXPECT_EQ(plan.fewest_substeps(), 8u) << "the caller's number";
    plan.least_substeps = 5;
    plan.most_substeps = 20;
    EXPECT_EQ(plan.fewest_substeps(), 5u);
}

TEST(Multirate, sub_steps_begin_evenly) {
    for (const uint substeps : {8u, 16u, 32u}) {
        const uint traits = engine::slowness_trait(32, substeps) | engine::k_trait_movable;
        EXPECT_TRUE(engine::is_multirate(traits));
        EXPECT_EQ(engine::ticks_of(substeps, traits), 32u);
        for (uint tick = 0; tick <= 32; ++tick) {
            const uint apart = 32 / substeps;
            EXPECT_EQ(engine::substep_at(tick, traits), tick % apart == 0 ? tick / apart : engine::k_none) << tick;
        }
    }
    EXPECT_FALSE(engine::is_multirate(engine::k_trait_movable | engine::k_trait_whole_hub));
    EXPECT_EQ(engine::substep_at(7, engine::k_trait_movable), 7u) << "of what is not multirate each tick is one";
}

TEST(Multirate, a_change_is_spread_over_the_sub_steps_of_a_faster_body) {
    const uint slow = engine::slowness_trait(32, 8), fast = engine::slowness_trait(32, 32);
    EXPECT_EQ(engine::part_of_change(slow, fast), 0.25f);
    EXPECT_EQ(engine::part_of_change(slow, slow), 1.0f);
    EXPECT_EQ(engine::part_of_change(fast, 0), 1.0f) << "of what cannot be pushed";
    engine::BodyVelocity before{}, after{};
    before.linear = {1.0f, 2.0f, 3.0f};
    after.linear = {5.0f, 2.0f, 3.3f};
    EXPECT_EQ(engine::change_in_part(before, after, 0.25f).linear.x, 2.0f);
    EXPECT_EQ(engine::change_in_part(before, after, 1.0f).linear, after.linear) << "to the last bit";
}

TEST(Multirate, what_stands_on_a_corner_asks_for_more) {
    EXPECT_GT(engine::needed_substeps(60.0f, 4.0f, 1, false), 1.9f * engine::needed_substeps(60.0f, 1.0f, 1, false));
    const engine::vec4 of_face(125.0f), of_corner(125.0f, 0.0f, 0.0f, 0.0f); // kg, between two boxes of 1 t
    EXPECT_NEAR(engine::yielding_of({50.0f, 50.0f, 50.0f, 50.0f}, of_face, 1e-3f), 1.0f, 1e-5f);
    EXPECT_NEAR(engine::yielding_of({200.0f, 0.0f, 0.0f, 0.0f}, of_face, 1e-3f), 4.0f, 1e-5f);
    EXPECT_NEAR(engine::yielding_of({200.0f, 0.0f, 0.0f, 0.0f}, of_corner, 1e-3f), 4.0f, 1e-5f);
    EXPECT_EQ(engine::yielding_of(engine::vec4(0.0f), of_face, 1e-3f), 1.0f) << "it carries nothing";
}

/// Contacts of each colour stand by their rate, the fastest first. `count`: how many have more sub-steps than most.
void expect_the_fast_first(const EngineRun& run, uint& count) {
    const uint slowest =
        engine::slowness_at(run.counter(engine::k_counter_launched_substeps), static_cast<uint>(run.settings.substeps));
    const auto offsets = run.read<uint>(BufferId::ColourOffsets, engine::k_offset_words);
    const auto constraints =
        run.read<engine::ContactConstraint>(BufferId::Constraints, run.counter(engine::k_counter_manifold_count));
    for (uint colour = 0; colour < engine::k_first_hub_colour; ++colour) {
        for (uint i = offsets[colour]; i < offsets[colour + 1]; ++i) {
            uint r = 0;
            while (r < engine::k_most_doublings && i >= offsets[engine::rate_end_word(colour, r)])
                ++r;
            const uint traits = constraints[i].traits;
            ASSERT_EQ(r, engine::slowness(traits)) << "manifold " << i << " of colour " << colour;
            count += engine::is_multirate(traits) && r < slowest ? 1 : 0;
        }
    }
}

class MultirateIslands : public OnDevice {
protected:
    /// Steps of one launch, of several numbers of groups, beside those of a launch a colour and pass on both devices.
    static void step_in_all_ways(EngineRun& one, EngineRun& many, EngineRun& expected) {
        for (const uint groups : k_numbers_of_groups) {
            one.step_persistently(groups % 2 == 1, groups);
            many.step_in_many_launches();
            expected.step_in_many_launches();
            ASSERT_TRUE(one.motion() == many.motion()) << groups << " groups";
            ASSERT_TRUE(one.motion() == expected.motion()) << groups << " groups";
            uint fast = 0;
            ASSERT_NO_FATAL_FAILURE(expect_the_fast_first(one, fast)) << groups << " groups";
            EXPECT_GT(fast, 0u);
        }
    }
};

TEST_P(MultirateIslands, have_the_same_bits_on_every_device_and_path) {
    Settings hubs = eight_at_most();
    hubs.hub_contacts = 32;
    // On hardware so long that an invocation of a single group has more contacts than it has marks for.
    const bool on_hardware = EngineRun(options_on(GetParam()), {}).simulation.state_device().loops_freely();
    for (const auto& [bodies, settings] :
         {std::pair{long_wall(on_hardware ? 760 : 190), eight_at_most()}, std::pair{table_on_legs(33, 3), hubs}}) {
        WorldOptions serial = options_on(DeviceKind::Cpu);
        serial.threads = 1;
        EngineRun one(options_on(GetParam()), bodies, settings), many(options_on(GetParam()), bodies, settings);
        EngineRun expected(serial, bodies, settings);
        for (EngineRun* each : {&one, &many, &expected}) {
            each->simulation.reserve_pairs(32768);
            each->least_multirate = 1025;
            each->step(); // finds out how much room the hubs need
            ask_for_different_substeps(*each);
        }
        ASSERT_NO_FATAL_FAILURE(step_in_all_ways(one, many, expected));
        const Contacts contacts = count_contacts(one);
        EXPECT_GT(contacts.slow, 500u);
        EXPECT_GT(contacts.fast, 200u);
        EXPECT_GT(contacts.beside_faster, 200u);
    }
}

TEST_P(MultirateIslands, sleep_in_parts_and_what_is_awake_keeps_its_sub_steps) {
    Settings settings = eight_at_most();
    settings.sleeping = true;
    settings.sleep_time = 0.05f;
    std::vector<BodyDefinition> bodies = long_wall();
    bodies[0] = box_at({95.0f, -1.0f, 0.0f}, {200.0f, 2.0f, 20.0f}, BodyKind::Static); // below all of it
    bodies.push_back(sphere_at({40.0f, 6.5f, 0.0f}));
    bodies.back().velocity.linear = {1.0f, 0.0f, 0.0f};
    WorldOptions serial = options_on(DeviceKind::Cpu);
    serial.threads = 1;
    EngineRun one(options_on(GetParam()), bodies, settings), many(options_on(GetParam()), bodies, settings);
    EngineRun expected(serial, bodies, settings);
    for (EngineRun* each : {&one, &many, &expected}) {
        each->simulation.reserve_pairs(8192);
        each->least_multirate = 1025;
        for (int i = 0; i < 12; ++i)
            each->step_in_many_launches();
        ask_for_different_substeps(*each);
    }
    ASSERT_NO_FATAL_FAILURE(step_in_all_ways(one, many, expected));
    const uint sleeping = one.counter(engine::k_counter_sleeping_bodies);
    EXPECT_GT(sleeping, 500u);
    EXPECT_LT(sleeping, bodies.size() - 3);
    EXPECT_GE(one.counter(engine::k_counter_multirate_islands), 1u) << "of three bodies or so";
    const Contacts contacts = count_contacts(one);
    EXPECT_GT(contacts.slow, 0u);
    EXPECT_GT(contacts.fast, 0u);
}

/// Also while it falls, when its islands have one number each, and few or many of them are solved by the same launch.
TEST_P(MultirateIslands, a_heap_of_light_and_heavy_boxes_has_the_same_bits) {
    const scenes::Scene scene = scenes::make_scene("pile:boxes=2000");
    std::vector<BodyDefinition> bodies;
    for (const scenes::NamedBody& body : scene.bodies)
        bodies.push_back(body.definition);
    for (std::size_t i = 10; i < bodies.size(); i += 45)
        bodies[i].mass = 20000.0f;
    EngineRun one(options_on(GetParam()), bodies, eight_at_most());
    EngineRun expected(options_on(DeviceKind::Cpu), bodies, eight_at_most());
    for (EngineRun* each : {&one, &expected}) {
        each->simulation.reserve_pairs(16384);
        each->least_multirate = 700;
    }
    uint most_fast = 0, most_with_fewest = 0, multirate_steps = 0;
    for (uint step = 0; step < 260; ++step) {
        one.step_persistently(step % 2 == 0);
        expected.step_in_many_launches();
        ASSERT_TRUE(one.motion() == expected.motion()) << step;
        if (one.counter(engine::k_counter_multirate_islands) == 0) continue;
        ++multirate_steps;
        uint fast = 0;
        ASSERT_NO_FATAL_FAILURE(expect_the_fast_first(one, fast));
        most_fast = std::max(most_fast, fast);
        most_with_fewest = std::max(most_with_fewest, count_asking(one, 1));
    }
    EXPECT_GT(multirate_steps, 5u);
    EXPECT_GT(most_fast, 50u);
    EXPECT_GT(most_with_fewest, 100u);
}

/// By its own load only the lower contacts of a tower would have the most, and it would lean.
TEST_P(MultirateIslands, a_tall_column_has_what_its_foot_asks_for) {
    constexpr uint k_height = 36;
    const std::vector<BodyDefinition> bodies = tower_in_large_world(k_height);
    EngineRun one(options_on(GetParam()), bodies, eight_at_most());
    EngineRun expected(options_on(DeviceKind::Cpu), bodies, eight_at_most());
    for (EngineRun* each : {&one, &expected}) {
        each->simulation.reserve_pairs(8192);
        each->least_multirate = k_height;
    }
    for (uint step = 0; step < 120; ++step) {
        one.step_persistently(step % 2 == 0);
        expected.step_in_many_launches();
        ASSERT_TRUE(one.motion() == expected.motion()) << step;
    }
    EXPECT_EQ(one.counter(engine::k_counter_multirate_islands), 1u);
    const auto constraints =
        one.read<engine::ContactConstraint>(BufferId::Constraints, one.counter(engine::k_counter_manifold_count));
    const std::vector<engine::Manifold> manifolds = one.manifolds();
    uint of_tower = 0, ask_for_less = 0;
    for (const engine::ContactConstraint& c : constraints) {
        if (c.body_a == 0 || c.body_b > k_height) continue;
        const bool at_the_top = c.body_b + 2 > k_height; // where bodies carry no more than two of their own mass
        ++of_tower;
        ask_for_less += engine::substeps_of(manifolds[c.manifold].demand) < 8 ? 1 : 0;
        EXPECT_EQ(engine::substeps_of_contact(c.counts) == 8, !at_the_top) << "below box " << c.body_b;
        EXPECT_GE(engine::substeps_of_contact(c.counts), 2u) << "half of that is for islands without tall columns";
    }
    EXPECT_EQ(of_tower, k_height - 1);
    EXPECT_GT(ask_for_less, k_height / 4);
}

TALUS_ON_EVERY_DEVICE(MultirateIslands);

/// Other numbers shake what stands, and so change what it asks for: with limits at 20 contacts and at three masses
/// alone a tower of 23 boxes never came to rest.
TEST(Multirate, a_tower_keeps_the_rates_that_it_has) {
    for (const uint height : {19u, 20u, 21u, 22u, 23u, 24u, 26u, 36u, 50u}) {
        SCOPED_TRACE(height);
        Settings settings;
        settings.max_substeps = 32;
        EngineRun run(options_on(DeviceKind::Cpu), tower_in_large_world(height), settings);
        run.simulation.reserve_pairs(8192);
        run.least_multirate = height;
        uint graphs = 0;
        for (uint step = 0; step < 400; ++step) {
            run.step_in_many_launches();
            if (step >= 300) graphs += run.counter(engine::k_counter_graph_due) != 0 ? 1 : 0;
        }
        EXPECT_EQ(run.counter(engine::k_counter_multirate_islands), 1u);
        EXPECT_EQ(graphs, 0u);
        const auto velocities = run.read<engine::BodyVelocity>(BufferId::Velocities, height + 1);
        for (uint i = 1; i <= height; ++i)
            EXPECT_LT(glm::length(velocities[i].linear), 5e-4f) << "box " << i;
    }
}

TEST(Multirate, a_foot_rate_is_told_upwards_and_kept) {
    Settings settings;
    settings.max_substeps = 32;
    const engine::StepPlan plan{.least_substeps = 8, .most_substeps = 32};
    const engine::Parameters p = engine::make_parameters(settings, plan);
    const engine::Standing storey{true, true}, leaning{true, false};
    const auto demand = [](uint substeps, uint rate, uint height) {
        return engine::make_demand(substeps, 0, rate, height);
    };
    EXPECT_EQ(engine::foot_rate(demand(12, 0, 20), storey, 0, 0, p), 2u) << "a foot itself";
    EXPECT_EQ(engine::foot_rate(demand(12, 0, 19), storey, 0, 0, p), 0u);
    EXPECT_EQ(engine::foot_rate(demand(12, 2, 15), storey, 0, 0, p), 2u) << "it has been one";
    EXPECT_EQ(engine::foot_rate(demand(12, 2, 14), storey, 0, 0, p), 0u);
    EXPECT_EQ(engine::foot_rate(demand(8, 0, 5), storey, 3, 40, p), 3u) << "above one that asks for 32";
    EXPECT_EQ(engine::foot_rate(demand(8, 0, 5), storey, 3, 39, p), 0u) << "the body below carries too little";
    EXPECT_EQ(engine::foot_rate(demand(8, 3, 5), storey, 3, 24, p), 3u);
    EXPECT_EQ(engine::foot_rate(demand(8, 3, 5), storey, 2, 24, p), 2u) << "the foot asks for less";
    EXPECT_EQ(engine::foot_rate(demand(8, 0, 5), leaning, 3, 100, p), 0u);
    EXPECT_EQ(engine::multirate_substeps(8, 0, true, p), 8u);
    EXPECT_EQ(engine::multirate_substeps(8, 3, true, p), 32u);
    EXPECT_EQ(engine::multirate_substeps(24, 2, true, p), 32u);
    const engine::StepPlan lowered{.least_substeps = 8, .most_substeps = 16};
    EXPECT_EQ(engine::multirate_substeps(8, 3, true, engine::make_parameters(settings, lowered)), 16u);
}

TEST(Multirate, where_the_most_is_no_double_of_the_least_islands_have_one_number) {
    std::vector<BodyDefinition> bodies = long_wall();
    for (std::size_t i = 1; i < bodies.size(); ++i)
        bodies[i].pose.position.y += 50.0f;
    for (const uint least : {2u, 3u, 5u, 8u}) {
        SCOPED_TRACE(least);
        Settings settings = eight_at_most();
        settings.substeps = least;
        EngineRun run(options_on(DeviceKind::Cpu), bodies, settings);
        run.simulation.reserve_pairs(8192);
        run.least_multirate = 1025;
        run.step_in_many_launches();
        ask_for_different_substeps(run);
        run.step_persistently(false);
        const bool is_double = 8 % least == 0;
        EXPECT_EQ(run.counter(engine::k_counter_multirate_islands), is_double ? 1u : 0u);
        const auto velocities = run.read<engine::BodyVelocity>(BufferId::Velocities, bodies.size());
        double mean = 0.0; // m/s, of bodies of one mass
        for (std::size_t i = 1; i < bodies.size(); ++i)
            mean += velocities[i].linear.y / static_cast<double>(bodies.size() - 1);
        EXPECT_NEAR(mean, -2.0 / 60.0 * 9.81, 1e-4) << "they fall for two whole steps";
    }
}

/// The wall in the air, its bodies thrown together: what contacts do to it has to add up to nothing.
TEST(Multirate, momentum_is_kept) {
    std::vector<BodyDefinition> bodies = long_wall();
    for (std::size_t i = 1; i < bodies.size(); ++i) {
        bodies[i].pose.position.y += 50.0f;
        bodies[i].mass = i % 5 == 0 ? 4000.0f : 1000.0f;
        bodies[i].velocity.linear = {0.3f * std::sin(static_cast<float>(i)), 0.2f * std::cos(static_cast<float>(7 * i)),
                                     0.0f};
    }
    EngineRun run(options_on(DeviceKind::Cpu), bodies, eight_at_most());
    run.simulation.reserve_pairs(8192);
    run.least_multirate = 1000;
    const auto momentum = [&] {
        double x = 0.0, y = 0.0, scale = 0.0;
        const auto velocities = run.read<engine::BodyVelocity>(BufferId::Velocities, bodies.size());
        for (std::size_t i = 1; i < bodies.size(); ++i) {
            x += *bodies[i].mass * velocities[i].linear.x;
            y += *bodies[i].mass * velocities[i].linear.y;
            scale += *bodies[i].mass * std::abs(velocities[i].linear.x);
        }
        return std::array{x, y, scale};
    };
    run.step_in_many_launches();
    ask_for_different_substeps(run);
    double mass = 0.0;
    for (std::size_t i = 1; i < bodies.size(); ++i)
        mass += *bodies[i].mass;
    const auto before = momentum();
    for (int i = 0; i < 5; ++i) {
        ask_for_different_substeps(run);
        run.step_in_many_launches();
        EXPECT_GT(count_contacts(run).beside_faster, 100u);
    }
    const auto after = momentum();
    EXPECT_NEAR(after[0], before[0], 1e-5 * before[2]);
    EXPECT_NEAR(after[1], before[1] - 5.0 / 60.0 * 9.81 * mass, 1e-5 * 9.81 / 12.0 * mass);
}

} // namespace
} // namespace talus::tests
