// SPDX-License-Identifier: MIT
// The constraint graph: no two contacts of one colour share a body that can be pushed, the colours are the same on
// every device, they are kept from step to step, and bodies with more contacts than there are colours are solved all
// the same.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::Manifold;
using engine::uint;

using Colours = std::map<std::pair<uint, uint>, uint>; // of each pair of bodies that touch

Colours colours_of(const EngineRun& run) {
    Colours colours;
    for (const Manifold& manifold : run.manifolds())
        if (manifold.point_count > 0) colours[{manifold.body_a, manifold.body_b}] = manifold.colour;
    return colours;
}

void expect_valid(const EngineRun& run) {
    std::set<std::pair<uint, uint>> used; // body and colour
    uint largest = 0, overflow = 0, touching = 0;
    for (const auto& [bodies, colour] : colours_of(run)) {
        ++touching;
        ASSERT_LE(colour, engine::k_overflow_colour) << bodies.first << ", " << bodies.second;
        if (colour == engine::k_overflow_colour) {
            ++overflow;
            continue;
        }
        largest = std::max(largest, colour + 1);
        for (const uint body : {bodies.first, bodies.second}) {
            if (!engine::is_movable(run.table.shapes[body])) continue;
            EXPECT_TRUE(used.insert({body, colour}).second) << "body " << body << " is twice in colour " << colour;
        }
    }
    EXPECT_EQ(run.counter(engine::k_counter_manifold_count), touching);
    EXPECT_EQ(run.counter(engine::k_counter_colour_demand), largest);
    EXPECT_EQ(run.counter(engine::k_counter_overflow_count), overflow);
}

struct Case {
    std::string name;
    uint steps;
};
const Case k_cases[]{{"stack", 3}, {"pyramid:base=8", 5}, {"wall:width=6,height=5", 5}, {"pool:boxes=80", 90}};

class Colouring : public OnDevice {};

TEST_P(Colouring, no_body_is_twice_in_a_colour) {
    for (const Case& c : k_cases) {
        SCOPED_TRACE(c.name);
        EngineRun run(options_on(GetParam()), bodies_of(c.name));
        run.step();
        expect_valid(run);
        run.step(c.steps);
        expect_valid(run);
    }
}

TEST_P(Colouring, is_that_of_a_single_thread) {
    for (const Case& c : k_cases) {
        SCOPED_TRACE(c.name);
        WorldOptions serial = options_on(DeviceKind::Cpu);
        serial.threads = 1;
        EngineRun run(options_on(GetParam()), bodies_of(c.name)), expected(serial, bodies_of(c.name));
        run.step(c.steps);
        expected.step(c.steps);
        EXPECT_EQ(colours_of(run), colours_of(expected));
    }
}

TEST_P(Colouring, contacts_keep_their_colours) {
    EngineRun run(options_on(GetParam()), bodies_of("pool:boxes=60"));
    run.step(60);
    std::size_t kept = 0;
    for (int i = 0; i < 10; ++i) {
        const Colours before = colours_of(run);
        run.step();
        for (const auto& [bodies, colour] : colours_of(run)) {
            const auto old = before.find(bodies);
            if (old == before.end() || old->second == engine::k_overflow_colour) continue;
            EXPECT_EQ(colour, old->second);
            ++kept;
        }
    }
    EXPECT_GT(kept, 100u) << "the scene must have contacts that last";
}

TEST_P(Colouring, a_body_with_more_contacts_than_colours_is_solved) {
    const std::vector<BodyDefinition> bodies = plate_of(9);
    EngineRun run(options_on(GetParam()), bodies);
    run.step();
    expect_valid(run);
    EXPECT_EQ(run.counter(engine::k_counter_colour_demand), engine::k_max_colours);
    EXPECT_EQ(run.counter(engine::k_counter_overflow_count), 81u + 1u - engine::k_max_colours);
    run.step(29);
    expect_valid(run);
    const auto poses = run.read<engine::BodyPose>(BufferId::Poses, bodies.size());
    for (std::size_t i = 1; i < bodies.size(); ++i) {
        const Vec3 start = bodies[i].pose.position;
        // A contact at rest sinks by less than a millimetre before it carries.
        EXPECT_NEAR(poses[i].position.y, start.y, 2e-3f) << i;
        EXPECT_NEAR(poses[i].position.x, start.x, 1e-3f) << i;
        EXPECT_NEAR(poses[i].position.z, start.z, 1e-3f) << i;
    }
}

TEST_P(Colouring, overflow_gives_the_same_bits_as_on_one_thread) {
    WorldOptions serial = options_on(DeviceKind::Cpu);
    serial.threads = 1;
    EngineRun run(options_on(GetParam()), plate_of(9)), expected(serial, plate_of(9));
    run.step(10);
    expected.step(10);
    EXPECT_TRUE(run.motion() == expected.motion());
}

TEST_P(Colouring, in_sequential_order_there_are_no_colours) {
    World world = make_world();
    world.add(bodies_of("stack:height=4"));
    world.step(3);
    EXPECT_EQ(world.report().colours, 2u);
    Settings settings;
    settings.solve_order = SolveOrder::Sequential;
    world.set_settings(settings); // contacts that had a colour lose it
    world.step(40);
    EXPECT_EQ(world.report().colours, 0u);
    EXPECT_EQ(world.report().contacts, 16u);
    EXPECT_LT(largest_speed(world), 0.01f);
    settings.solve_order = SolveOrder::Coloured;
    world.set_settings(settings);
    world.step();
    EXPECT_EQ(world.report().colours, 2u);
}

TALUS_ON_EVERY_DEVICE(Colouring);

} // namespace
} // namespace talus::tests
