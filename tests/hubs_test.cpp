// SPDX-License-Identifier: MIT
// Hubs: bodies with so many contacts that these get shares of their mass. They stand as other bodies do, also where a
// few contacts carry nearly all of the load.
#include <functional>
#include <ostream>

#include <gtest/gtest.h>

#include "state/formulas.h"
#include "tests/devices.h"
#include "tests/engine_run.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::uint;

// ---- scenes ----

std::vector<BodyDefinition> table_of_four() {
    return table_on_legs(8, 2);
}

std::vector<BodyDefinition> large_table(std::uint32_t legs_across) {
    return table_on_legs(34, legs_across, 1.0f);
}

/// On the boxes of the first table lies a second one, without legs.
std::vector<BodyDefinition> table_on_table() {
    std::vector<BodyDefinition> bodies = table_of_four(), upper(bodies.begin() + 6, bodies.end());
    for (BodyDefinition& body : upper)
        body.pose.position.y += 0.75f;
    BodyDefinition top = bodies[1];
    top.pose.position.y += 0.75f;
    bodies.push_back(top);
    bodies.insert(bodies.end(), upper.begin(), upper.end());
    return bodies;
}

/// The second one lies on the first, and boxes on both sides of the pair: the hubs touch.
std::vector<BodyDefinition> two_tops() {
    std::vector<BodyDefinition> bodies = table_of_four();
    for (std::size_t i = 6; i < bodies.size(); ++i)
        bodies[i].pose.position.y += 0.25f;
    BodyDefinition top = bodies[1];
    top.pose.position.y += 0.25f;
    bodies.push_back(top);
    for (std::uint32_t i = 0; i < 36; ++i) // under the lower one
        bodies.push_back(
            box_at({0.8f * static_cast<float>(i % 6) - 2.0f, 0.5f, 0.8f * static_cast<float>(i / 6) - 2.0f},
                   {0.3f, 1.0f, 0.3f}));
    return bodies;
}

/// A plate on 49 boxes, with a block of 30 t near one of its corners.
std::vector<BodyDefinition> plate_with_a_block() {
    std::vector<BodyDefinition> bodies = two_plates(7);
    std::erase_if(bodies, [](const BodyDefinition& body) { return body.pose.position.y > 1.0f; });
    bodies.push_back(box_at({2.0f, 2.0f, 1.0f}, {2.0f, 2.0f, 2.0f}));
    bodies.back().mass = 30'000.0f;
    return bodies;
}

struct Case {
    const char* name;
    std::uint32_t hub_contacts; // 0: the default
    int steps;
    std::function<std::vector<BodyDefinition>()> bodies;

    friend std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }
};

const Case k_cases[] = {
    {"four_legs", 32, 600, table_of_four},
    {"table_on_table", 32, 600, table_on_table},
    {"hubs_that_touch", 32, 600, two_tops},
    {"block_on_a_plate", 32, 600, plate_with_a_block},
    {"four_legs_and_1156_boxes", 0, 180, [] { return large_table(2); }},
    {"25_legs_and_1156_boxes", 0, 180, [] { return large_table(5); }},
    {"100_legs_and_1156_boxes", 0, 180, [] { return large_table(10); }},
};

class Hubs : public testing::TestWithParam<Case> {};

TEST_P(Hubs, stand) {
    const std::vector<BodyDefinition> bodies = GetParam().bodies();
    Settings settings;
    if (GetParam().hub_contacts > 0) settings.hub_contacts = GetParam().hub_contacts;
    World world(settings, options_on(DeviceKind::Cpu));
    const std::vector<BodyId> ids = world.add(bodies);
    const double start = mechanical_energy(world);
    double most = start;
    float fastest = 0.0f;
    for (int i = 0; i < GetParam().steps; ++i) {
        world.step();
        most = std::max(most, mechanical_energy(world));
        fastest = std::max(fastest, largest_speed(world));
    }
    EXPECT_GT(world.report().hubs, 0u);
    EXPECT_LE(most, 1.001 * start) << "gained " << 100.0 * (most / start - 1.0) << " %";
    EXPECT_LT(fastest, 0.1f) << "while the contacts took up their loads";
    EXPECT_LT(largest_speed(world), 1e-3f) << "at rest";
    float moved = 0.0f, overlap = 0.0f;
    for (std::size_t i = 1; i < ids.size(); ++i)
        moved = std::max(moved, length(world.pose(ids[i]).position - bodies[i].pose.position));
    for (const Contact& contact : world.contacts())
        for (const ContactPoint& point : contact.points)
            overlap = std::max(overlap, -point.separation);
    EXPECT_LT(moved, 2e-3f);
    EXPECT_LT(overlap, 2e-3f);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Hubs, testing::ValuesIn(k_cases),
                         [](const auto& test) { return std::string(test.param.name); });

/// What falls on a hub is new to it, and may be as heavy as the hub.
TEST(HubsThatAreHit, gain_no_energy) {
    for (const float mass : {2'000.0f, 8'000.0f, 20'000.0f, 30'000.0f, 40'000.0f}) {
        SCOPED_TRACE(mass);
        std::vector<BodyDefinition> bodies = plate_with_a_block();
        bodies.back().pose.position.y += 2.0f;
        bodies.back().mass = mass;
        World world(with_hubs(), options_on(DeviceKind::Cpu));
        world.add(bodies);
        const double start = mechanical_energy(world);
        double most = start;
        for (int i = 0; i < 240; ++i) {
            world.step();
            most = std::max(most, mechanical_energy(world));
        }
        EXPECT_LE(most, 1.001 * start) << "gained " << 100.0 * (most / start - 1.0) << " %";
    }
}

// ---- who gets what ----

class HubShares : public OnDevice {};

/// The solver's records that the last step has left, by colour and otherwise.
std::vector<engine::ContactConstraint> constraints_of(const EngineRun& run) {
    return run.read<engine::ContactConstraint>(BufferId::Constraints, run.counter(engine::k_counter_manifold_count));
}

bool is_share(const engine::ContactConstraint& c) {
    return ((c.traits | c.traits >> engine::k_traits_of_b) & engine::k_trait_hub) != 0;
}

TEST_P(HubShares, what_carries_much_has_the_whole_mass_and_the_rest_share_it) {
    constexpr uint k_table = 1, k_last_leg = 5;
    EngineRun run(options_on(GetParam()), table_of_four(), with_hubs());
    for (int i = 0; i < 5; ++i) {
        run.step();
        float sum = 0.0f, least = 1.0f, largest = 0.0f;
        uint legs = 0;
        for (const engine::ContactConstraint& c : constraints_of(run)) {
            if (is_share(c)) {
                EXPECT_GT(std::max(c.body_a, c.body_b), k_last_leg) << "a leg carries a quarter";
                sum += c.hub_share;
                least = std::min(least, c.hub_share);
                largest = std::max(largest, c.hub_share);
            } else if (c.body_a == k_table || c.body_b == k_table) {
                ++legs;
                EXPECT_LE(std::max(c.body_a, c.body_b), k_last_leg);
            }
        }
        EXPECT_EQ(legs, 4u);
        EXPECT_EQ(run.counter(engine::k_counter_hub_manifolds), 64u);
        EXPECT_NEAR(sum, 1.0f, 1e-5f);
        EXPECT_GT(least, 0.4f / 64.0f) << "half of the mass is shared alike";
        EXPECT_LT(largest, 2.0f / 64.0f) << "the boxes have the same weight";
    }
}

TEST_P(HubShares, the_larger_load_has_the_larger_share) {
    std::vector<BodyDefinition> bodies = table_of_four();
    bodies[10].mass = 5.0f * 125.0f;
    EngineRun run(options_on(GetParam()), bodies, with_hubs());
    run.step(6);
    float heavy = 0.0f, others = 0.0f;
    for (const engine::ContactConstraint& c : constraints_of(run))
        if (is_share(c)) (c.body_b == 10 ? heavy : others) = std::max(c.body_b == 10 ? heavy : others, c.hub_share);
    EXPECT_GT(heavy, 2.0f * others);
}

TEST_P(HubShares, are_the_same_bits_on_every_device_and_with_one_thread) {
    WorldOptions serial = options_on(DeviceKind::Cpu);
    serial.threads = 1;
    for (const auto& bodies : {table_of_four(), plate_with_a_block()}) {
        EngineRun run(options_on(GetParam()), bodies, with_hubs()), expected(serial, bodies, with_hubs());
        run.step(6);
        expected.step(6);
        EXPECT_TRUE(run.motion() == expected.motion());
    }
}

TEST_P(HubShares, are_the_same_bits_in_one_persistent_launch_and_in_many) {
    Settings settings = with_hubs();
    settings.substeps = settings.max_substeps = 2; // renderers in software end long loops
    EngineRun one(options_on(GetParam()), plate_with_a_block(), settings);
    EngineRun many(options_on(GetParam()), plate_with_a_block(), settings);
    one.step(); // finds out how much room the hubs need
    many.step();
    for (const engine::uint groups : k_numbers_of_groups) {
        one.step_persistently(false, groups);
        many.step_in_many_launches();
        ASSERT_TRUE(one.motion() == many.motion()) << groups << " groups";
    }
    EXPECT_GT(one.counter(engine::k_counter_hub_manifolds), 0u);
}

TALUS_ON_EVERY_DEVICE(HubShares);

} // namespace
} // namespace talus::tests
