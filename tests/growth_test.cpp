// SPDX-License-Identifier: MIT
// Buffers that start too small: nothing is dropped, growth is reported, and the bits are those of a world which had
// room from the start.
#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/environment.h"

namespace talus::tests {
namespace {

constexpr Capacities k_tiny{1, 1, 1};
constexpr Capacities k_ample{2'048, 8'192, 64};

class Growth : public OnDevice {
protected:
    World world_with(const Capacities& capacities) const {
        WorldOptions options = options_on(GetParam());
        options.capacities = capacities;
        Settings settings;
        settings.max_substeps = settings.substeps; // more of them would ask for launches as well
        return World(settings, options);
    }
};

TEST_P(Growth, gives_the_bits_of_a_world_that_had_room) {
    for (const char* scene : {"stack", "pyramid:base=7", "pool:boxes=80"}) {
        SCOPED_TRACE(scene);
        World tiny = world_with(k_tiny), ample = world_with(k_ample);
        tiny.add(bodies_of(scene));
        ample.add(bodies_of(scene));
        for (int i = 0; i < 4; ++i) {
            // Several steps are on their way when the first of them is found not to fit.
            tiny.step(20);
            ample.step(20);
            ASSERT_EQ(tiny.state_hash(), ample.state_hash()) << "after step " << tiny.step_count();
        }
        EXPECT_GT(tiny.report().growths, 0u);
        EXPECT_EQ(ample.report().growths, 0u);
        EXPECT_EQ(tiny.report().step, 80u);
        EXPECT_EQ(tiny.report().contacts, ample.report().contacts);
        EXPECT_EQ(tiny.report().pairs, ample.report().pairs);
    }
}

TEST_P(Growth, of_bodies_and_pairs_gives_the_same_bits_with_the_tree) {
    World tiny = world_with(k_tiny), ample = world_with(k_ample);
    for (World* world : {&tiny, &ample}) {
        Settings settings = world->settings();
        settings.broad_phase = BroadPhase::Bvh;
        world->set_settings(settings);
        world->add(bodies_of("pool:boxes=80"));
        world->step(50);
    }
    EXPECT_GT(tiny.report().growths, 0u);
    EXPECT_EQ(ample.report().growths, 0u);
    EXPECT_GT(ample.report().pairs, 50u);
    EXPECT_EQ(tiny.state_hash(), ample.state_hash());
}

TEST_P(Growth, of_colours_gives_the_same_bits_in_a_large_world) {
    // More bodies in an island than one work group solves, so that each colour has a launch of its own.
    const Variable no_persistent_launch("TALUS_RESIDENT_GROUPS", "0");
    World tiny = world_with({1, 16'384, 1}), ample = world_with({2'048, 16'384, 64});
    for (World* world : {&tiny, &ample}) {
        world->add(bodies_of("pyramid:base=46"));
        world->step(4);
    }
    EXPECT_GT(tiny.report().growths, 0u);
    EXPECT_EQ(ample.report().growths, 0u);
    EXPECT_EQ(tiny.state_hash(), ample.state_hash());
}

TEST_P(Growth, happens_at_every_step_of_a_world_that_fills_up) {
    World tiny = world_with(k_tiny), ample = world_with(k_ample);
    for (World* world : {&tiny, &ample}) {
        world->add(ground());
        for (int i = 0; i < 30; ++i) {
            const float x = 1.5f * static_cast<float>(i % 6), z = 1.5f * static_cast<float>(i / 6);
            world->add(box_at({x, 0.5f, z}));
            world->add_impulse(world->bodies().back(), {100.0f, 0.0f, 50.0f});
            world->step(2);
        }
    }
    EXPECT_GT(tiny.report().growths, 1u);
    EXPECT_EQ(tiny.state_hash(), ample.state_hash());
}

TEST_P(Growth, keeps_forces_for_the_step_that_is_made_again) {
    World tiny = world_with(k_tiny), ample = world_with(k_ample);
    for (World* world : {&tiny, &ample}) {
        world->add(bodies_of("stack:height=6"));
        world->add_force(world->bodies().back(), {5000.0f, 0.0f, 0.0f});
        world->step(3);
    }
    EXPECT_GT(tiny.report().growths, 0u);
    EXPECT_EQ(tiny.state_hash(), ample.state_hash());
    EXPECT_GT(tiny.velocity(tiny.bodies().back()).linear.x, 0.0f);
}

TALUS_ON_EVERY_DEVICE(Growth);

} // namespace
} // namespace talus::tests
