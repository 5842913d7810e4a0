// SPDX-License-Identifier: MIT
// The same scene ends in the same bits: run twice, with any number of threads, on every device, in one work group or in
// many launches.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "device/cpu/instruction_set.h"
#include "step_results.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

struct Case {
    const char* scene;
    std::uint32_t steps;
};
// The last one has more bodies than one work group solves.
const Case k_cases[]{{"stack", 100}, {"pyramid:base=8", 60}, {"pool:boxes=100", 60}, {"grid:stacks=230", 15}};

std::uint64_t hash_of(const WorldOptions& options, const Case& c, const Settings& settings = {}) {
    World world(settings, options);
    world.add(bodies_of(c.scene));
    world.step(c.steps);
    return world.state_hash();
}

std::uint64_t hash_on_one_thread(const Case& c) {
    WorldOptions options = options_on(DeviceKind::Cpu);
    options.threads = 1;
    return hash_of(options, c);
}

class Determinism : public OnDevice {};

TEST_P(Determinism, the_state_is_that_of_one_cpu_thread) {
    for (const Case& c : k_cases)
        EXPECT_EQ(hash_of(options_on(GetParam()), c), hash_on_one_thread(c)) << c.scene;
}

TEST(SetsOfInstructions, end_in_the_same_bits) {
    if (engine::runnable_sets() == 1) GTEST_SKIP() << "NOT TESTED, this machine has one set of instructions alone";
    const std::size_t widest = engine::usable_sets;
    // By sweep and by tree, of boxes and spheres, in one island and in many.
    for (const Case& c :
         {Case{"pool:boxes=300", 60}, {"rubble:boxes=300", 60}, {"pile:boxes=1200", 40}, {"worlds", 10}}) {
        engine::usable_sets = 1;
        const std::uint64_t expected = hash_on_one_thread(c);
        while (++engine::usable_sets <= engine::runnable_sets())
            EXPECT_EQ(hash_on_one_thread(c), expected) << c.scene << " with " << engine::usable_sets;
    }
    engine::usable_sets = widest;
}

TEST_P(Determinism, spheres_spin_and_bounces_end_in_the_same_bits) {
    World world = make_world(), expected({}, options_on(DeviceKind::Cpu));
    for (World* each : {&world, &expected}) {
        each->add(mixed_bodies());
        each->step(60);
    }
    EXPECT_EQ(world.state_hash(), expected.state_hash());
}

TEST_P(Determinism, two_runs_end_in_the_same_bits) {
    const Case c{"pool:boxes=70", 60};
    EXPECT_EQ(hash_of(options_on(GetParam()), c), hash_of(options_on(GetParam()), c));
    EXPECT_NE(hash_of(options_on(GetParam()), c), hash_of(options_on(GetParam()), {"pool:boxes=70", 61}));
    EXPECT_NE(hash_of(options_on(GetParam()), c), hash_of(options_on(GetParam()), {"pool:boxes=70,seed=2", 60}));
}

TEST_P(Determinism, looking_at_the_state_changes_nothing) {
    World watched = make_world(), unwatched = make_world();
    watched.add(bodies_of("pool:boxes=50"));
    unwatched.add(bodies_of("pool:boxes=50"));
    watched.keep_poses_coming(true);
    for (int i = 0; i < 40; ++i) {
        watched.step();
        watched.poses();
        watched.contacts();
        watched.collision_pairs();
        watched.report();
    }
    unwatched.step(40);
    EXPECT_EQ(watched.state_hash(), unwatched.state_hash());
}

TEST_P(Determinism, baumgarte_and_brute_force_are_repeatable_too) {
    Settings settings;
    settings.stabilisation = Stabilisation::Baumgarte;
    settings.iterations = 10;
    settings.broad_phase = BroadPhase::Brute;
    const Case c{"pyramid:base=6", 30};
    EXPECT_EQ(hash_of(options_on(GetParam()), c, settings), hash_of(options_on(DeviceKind::Cpu), c, settings));
}

TEST_P(Determinism, the_broad_phase_does_not_change_the_bits) {
    for (const Case& c : {Case{"pyramid:base=8", 20}, Case{"pool:boxes=70", 60}, Case{"grid:stacks=230", 5}})
        for (const BroadPhase kind : {BroadPhase::SweepAndPrune, BroadPhase::Bvh}) {
            Settings settings;
            settings.broad_phase = kind;
            EXPECT_EQ(hash_of(options_on(GetParam()), c, settings), hash_on_one_thread(c)) << c.scene;
        }
}

class Paths : public OnDevice {};

TEST_P(Paths, a_work_group_for_each_island_gives_the_bits_of_many_launches) {
    std::vector<BodyDefinition> bodies = bodies_of("pool:boxes=60");
    for (BodyDefinition& body : bodies)
        body.material.restitution = 0.3f;
    EngineRun small(options_on(GetParam()), bodies), large(options_on(GetParam()), bodies);
    small.simulation.reserve_pairs(4096); // the steps of many launches are made without growth
    large.simulation.reserve_pairs(4096);
    for (int i = 0; i < 60; ++i) {
        small.step();
        large.step_in_many_launches();
        ASSERT_TRUE(small.motion() == large.motion()) << "step " << i;
    }
    EXPECT_GT(small.counter(engine::k_counter_contact_count), 50u) << "the scene must have contacts by now";
}

TEST_P(Paths, both_kernels_for_islands_give_the_bits_of_many_launches) {
    Settings settings;
    settings.max_substeps = settings.substeps;
    for (const float restitution : {0.0f, 0.5f}) {
        SCOPED_TRACE(restitution);
        std::vector<BodyDefinition> bodies = bodies_of("pyramid:base=4");
        for (BodyDefinition& body : bodies) {
            body.material.restitution = restitution;
            if (body.kind == BodyKind::Rigid) body.velocity.linear = {0.3f, -2.0f, 0.1f};
        }
        EngineRun groups(options_on(GetParam()), bodies, settings), launches(options_on(GetParam()), bodies, settings);
        for (int i = 0; i < 20; ++i) {
            groups.step_in_groups(restitution > 0.0f || i % 2 == 1);
            launches.step_in_many_launches();
            ASSERT_TRUE(groups.motion() == launches.motion()) << "step " << i;
        }
        EXPECT_GT(groups.counter(engine::k_counter_contact_count), 20u) << "the scene must have contacts by now";
    }
}

TEST_P(Paths, an_island_may_have_more_manifolds_than_a_group_has_invocations) {
    for (const SolveOrder order : {SolveOrder::Coloured, SolveOrder::Sequential}) {
        SCOPED_TRACE(static_cast<int>(order));
        Settings settings;
        settings.substeps = settings.max_substeps = 2;
        settings.solve_order = order;
        std::vector<BodyDefinition> bodies = bodies_of("pyramid:base=20");
        for (BodyDefinition& body : bodies)
            if (body.kind == BodyKind::Rigid) body.velocity.linear = {0.3f, -1.0f, 0.1f};
        EngineRun groups(options_on(GetParam()), bodies, settings), launches(options_on(GetParam()), bodies, settings);
        groups.simulation.reserve_pairs(4096);
        launches.simulation.reserve_pairs(4096);
        for (int i = 0; i < 6; ++i) {
            groups.step_in_groups(i % 2 == 1);
            launches.step_in_many_launches();
            ASSERT_TRUE(groups.motion() == launches.motion()) << "step " << i;
        }
        EXPECT_GT(groups.counter(engine::k_counter_manifold_count), 384u);
    }
}

// In shared memory they have room beside the velocities of 511 body slots, or of 681 where contacts of a group wait one
// by one.
TEST_P(Paths, a_work_group_gives_the_same_bits_wherever_movements_lie) {
    Settings settings;
    settings.substeps = settings.max_substeps = 2;
    std::vector<BodyDefinition> bodies = bodies_of("pyramid:base=37");
    for (BodyDefinition& body : bodies)
        if (body.kind == BodyKind::Rigid) body.velocity.linear = {0.3f, -1.0f, 0.1f};
    for (const std::size_t count : {682u, 681u, 512u, 511u}) {
        SCOPED_TRACE(count);
        bodies.resize(count);
        EngineRun groups(options_on(GetParam()), bodies, settings), launches(options_on(GetParam()), bodies, settings);
        groups.simulation.reserve_pairs(4096);
        launches.simulation.reserve_pairs(4096);
        for (int i = 0; i < 3; ++i) {
            groups.step_in_groups(false);
            launches.step_in_many_launches();
            ASSERT_TRUE(groups.motion() == launches.motion()) << "step " << i;
        }
        EXPECT_GT(groups.counter(engine::k_counter_manifold_count), count);
    }
}

/// More than 1,024 bodies: stacks of three that fall over, a pyramid too large for a work group, and boxes in free
/// fall.
std::vector<BodyDefinition> many_islands(float restitution, int rows = 22) {
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < 280; ++i) {
        const float x = 2.5f * static_cast<float>(i % 20) - 25.0f, z = 2.5f * static_cast<float>(i / 20) + 5.0f;
        for (int level = 0; level < 3; ++level)
            bodies.push_back(box_at({x + 0.2f * static_cast<float>(level), 0.5f + static_cast<float>(level), z}));
        bodies.back().material.restitution = restitution;
    }
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < rows - row; ++i)
            bodies.push_back(box_at({1.01f * static_cast<float>(i) + 0.505f * static_cast<float>(row),
                                     0.5f + static_cast<float>(row), -5.0f}));
    for (int i = 0; i < 100; ++i)
        bodies.push_back(box_at({2.5f * static_cast<float>(i % 10), 50.0f, 2.5f * static_cast<float>(i / 10)}));
    for (BodyDefinition& body : bodies)
        if (body.kind == BodyKind::Rigid) body.velocity.linear = {0.3f, -1.0f, 0.1f};
    return bodies;
}

TEST_P(Paths, groups_of_islands_give_the_bits_of_many_launches) {
    Settings settings;
    settings.substeps = settings.max_substeps = 2;
    for (const float restitution : {0.0f, 0.5f}) {
        SCOPED_TRACE(restitution);
        const std::vector<BodyDefinition> bodies = many_islands(restitution);
        EngineRun groups(options_on(GetParam()), bodies, settings), launches(options_on(GetParam()), bodies, settings);
        groups.simulation.reserve_pairs(8192);
        launches.simulation.reserve_pairs(8192);
        for (int i = 0; i < 4; ++i) {
            groups.step_in_groups(restitution > 0.0f || i % 2 == 1);
            launches.step_in_many_launches();
            ASSERT_TRUE(groups.motion() == launches.motion()) << "step " << i;
        }
        EXPECT_GT(groups.counter(engine::k_counter_launched_colours), 0u) << "the pyramid needs launches";
        EXPECT_GT(groups.counter(engine::k_counter_manifold_count), 1000u);
    }
}

TEST_P(Paths, a_work_group_for_a_single_island_gives_the_bits_of_many_launches) {
    Settings settings;
    settings.substeps = settings.max_substeps = 2;
    // A pyramid of 253 bodies, and one of 703, which has no room for its movements in shared memory.
    for (const auto& [restitution, rows] : {std::pair(0.0f, 22), std::pair(0.5f, 22), std::pair(0.0f, 37)}) {
        SCOPED_TRACE(testing::Message() << restitution << ", " << rows << " rows");
        const std::vector<BodyDefinition> bodies = many_islands(restitution, rows);
        EngineRun singles(options_on(GetParam()), bodies, settings), launches(options_on(GetParam()), bodies, settings);
        singles.simulation.reserve_pairs(8192);
        launches.simulation.reserve_pairs(8192);
        for (int i = 0; i < 4; ++i) {
            singles.step_in_groups(restitution > 0.0f || i % 2 == 1, true);
            launches.step_in_many_launches();
            ASSERT_TRUE(singles.motion() == launches.motion()) << "step " << i;
            EXPECT_EQ(singles.counter(engine::k_counter_singles), 1u) << "the pyramid";
            EXPECT_EQ(singles.counter(engine::k_counter_launched_colours), 0u) << "nothing needs launches";
        }
    }
}

TEST_P(Paths, one_persistent_launch_gives_the_bits_of_many) {
    Settings coloured;
    coloured.substeps = coloured.max_substeps = 2;
    Settings sequential = coloured, iterated = coloured, without_relax_pass = coloured;
    sequential.solve_order = SolveOrder::Sequential;
    iterated.iterations = 3;
    without_relax_pass.stabilisation = Stabilisation::Baumgarte;
    without_relax_pass.iterations = 3;
    int number = 0;
    for (const Settings& settings : {coloured, sequential, iterated, without_relax_pass}) {
        SCOPED_TRACE(number++);
        const std::vector<BodyDefinition> bodies = many_islands(0.0f);
        EngineRun one(options_on(GetParam()), bodies, settings), many(options_on(GetParam()), bodies, settings);
        one.simulation.reserve_pairs(8192);
        many.simulation.reserve_pairs(8192);
        for (const engine::uint groups : k_numbers_of_groups) {
            one.step_persistently(groups % 2 == 1, groups);
            many.step_in_many_launches();
            ASSERT_TRUE(one.motion() == many.motion()) << groups << " groups";
        }
        EXPECT_GT(one.counter(engine::k_counter_manifold_count), 1000u);
    }
}

/// What is infinite, and freezes a body when a sub-step begins.
enum class Cause { Velocity, Force };

template <typename Record> void make_infinite(EngineRun& run, engine::BufferId buffer, glm::vec3 Record::*vector) {
    std::vector<Record> records = run.read<Record>(buffer, run.table.slot_count());
    for (const engine::uint body : {2u, 6u, 11u})
        (records[body].*vector).x = std::numeric_limits<float>::infinity();
    run.simulation.write(buffer, 0, std::span<const Record>(records));
}

void freeze_some(EngineRun& run, Cause cause) {
    if (cause == Cause::Velocity)
        return make_infinite(run, engine::BufferId::Velocities, &engine::BodyVelocity::linear);
    run.simulation.reserve_loads();
    make_infinite(run, engine::BufferId::Loads, &engine::BodyLoad::force);
}

TEST_P(Paths, frozen_bodies_give_the_bits_of_many_launches_in_a_persistent_one) {
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < 12; ++i)
        for (int level = 0; level < 4; ++level)
            bodies.push_back(box_at({2.5f * static_cast<float>(i) + 0.1f * static_cast<float>(level),
                                     0.5f + 0.99f * static_cast<float>(level), 0.0f}));
    Settings soft;
    soft.substeps = soft.max_substeps = 2;
    Settings without_relax_pass = soft;
    without_relax_pass.stabilisation = Stabilisation::Baumgarte;
    without_relax_pass.iterations = 3;
    for (const Settings& settings : {soft, without_relax_pass}) {
        for (const Cause cause : {Cause::Velocity, Cause::Force}) {
            SCOPED_TRACE(static_cast<int>(cause));
            EngineRun one(options_on(GetParam()), bodies, settings), many(options_on(GetParam()), bodies, settings);
            for (std::size_t i = 0; i < k_numbers_of_groups.size(); ++i) {
                if (i == 1) freeze_some(one, cause), freeze_some(many, cause);
                one.step_persistently(false, k_numbers_of_groups[i]);
                many.step_in_many_launches();
                ASSERT_TRUE(one.motion() == many.motion()) << "step " << i;
            }
            EXPECT_EQ(one.counter(engine::k_counter_frozen_bodies), 3u);
            EXPECT_EQ(one.counter(engine::k_counter_did_not_fit), 0u);
        }
    }
}

TEST_P(Paths, gpus_solve_large_islands_in_one_launch) {
    EngineRun run(options_on(GetParam()), many_islands(0.0f));
    engine::Device& device = run.simulation.state_device();
    const engine::uint groups = device.resident_groups(engine::solve_persistent);
    const bool on_hardware = GetParam() == DeviceKind::Gpu && device.loops_freely();
    EXPECT_EQ(groups > 1, on_hardware) << groups;
    run.simulation.reserve_pairs(8192);
    run.step();
    const engine::uint spare = groups / engine::k_groups_a_spare; // for the islands beside it
    EXPECT_EQ(run.simulation.plan_step(run.table.population()).persistent_groups, groups - spare)
        << "until the work is known";
}

TEST_P(Paths, groups_that_wait_in_vain_are_an_error) {
    EngineRun run(options_on(GetParam()), many_islands(0.0f));
    if (GetParam() != DeviceKind::Gpu || run.simulation.state_device().loops_freely())
        return; // only where one group runs after the other is it sure that they do
    run.simulation.reserve_pairs(8192);
    run.step();
    const auto poses_before = run.read<engine::BodyPose>(engine::BufferId::Poses, run.table.slot_count());
    const engine::uint old_pairs_before = run.counter(engine::k_counter_old_pair_count);
    run.step_persistently(false, 2, 2);
    EXPECT_EQ(run.counter(engine::k_counter_did_not_fit), engine::k_fit_groups);
    const auto poses = run.read<engine::BodyPose>(engine::BufferId::Poses, run.table.slot_count());
    for (std::size_t i = 0; i < poses.size(); ++i)
        EXPECT_EQ(std::memcmp(&poses[i], &poses_before[i], sizeof poses[i]), 0) << "nothing has moved, " << i;
    EXPECT_EQ(run.counter(engine::k_counter_old_pair_count), old_pairs_before);
    EXPECT_THROW(run.step(), Error);
    EXPECT_EQ(run.counter(engine::k_counter_searched_slots), 0u) << "the next step searches for pairs";
    const auto properties = run.read<engine::BodyProperties>(engine::BufferId::Properties, run.table.slot_count());
    const auto velocities = run.read<engine::BodyVelocity>(engine::BufferId::Velocities, run.table.slot_count());
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        EXPECT_EQ(velocities[i].inverse_mass, properties[i].inverse_mass) << i;
        EXPECT_EQ(velocities[i].stamp, 0u) << i;
    }
    EXPECT_EQ(run.counter(engine::k_counter_old_pair_count), 0u) << "constraints have been written over the contacts";
    EXPECT_TRUE(read_contacts(run.simulation).manifolds.empty());
    run.step();
    EXPECT_EQ(run.counter(engine::k_counter_old_pair_count), old_pairs_before);
    for (const engine::BodyPose& pose : run.read<engine::BodyPose>(engine::BufferId::Poses, run.table.slot_count()))
        EXPECT_TRUE(std::isfinite(pose.position.y));
}

TEST_P(Paths, islands_of_a_large_world_have_sub_steps_of_their_own) {
    EngineRun run(options_on(GetParam()), many_islands(0.0f));
    run.simulation.reserve_pairs(8192);
    run.step();
    const std::vector<engine::uint> substeps =
        run.read<engine::uint>(engine::BufferId::Substeps, 1 + 280 * 3 + 253 + 100);
    const std::vector<engine::uint> islands = run.read<engine::uint>(engine::BufferId::Islands, substeps.size());
    EXPECT_EQ(islands[0], engine::k_none) << "the ground is no part of an island";
    for (std::size_t body = 1; body <= 840; ++body) {
        const std::size_t lowest = body - (body - 1) % 3;
        EXPECT_EQ(islands[body], islands[lowest]) << "a stack is one island";
        EXPECT_TRUE(islands[body] >= lowest && islands[body] < lowest + 3) << "named by a body of its own";
        EXPECT_EQ(substeps[body], 32u) << "what has just been put together is on trial";
    }
    for (std::size_t body = substeps.size() - 100; body < substeps.size(); ++body) {
        EXPECT_EQ(islands[body], body);
        EXPECT_EQ(substeps[body], Settings{}.substeps) << "nothing loads a body in free fall";
    }
}

TEST_P(Paths, a_kinematic_body_may_belong_to_several_islands) {
    std::vector<BodyDefinition> bodies{ground(), box_at({0.0f, 0.25f, 0.0f}, {9.0f, 0.5f, 2.0f}, BodyKind::Kinematic)};
    bodies.back().velocity = {{0.5f, 0.0f, 0.0f}, {0.0f, 0.3f, 0.0f}};
    for (int i = 0; i < 12; ++i)
        bodies.push_back(box_at({2.0f * static_cast<float>(i % 4) - 3.0f, 1.0f + static_cast<float>(i / 4), 0.0f}));
    EngineRun small(options_on(GetParam()), bodies), large(options_on(GetParam()), bodies);
    EngineRun persistent(options_on(GetParam()), bodies);
    for (std::size_t i = 0; i < 40; ++i) {
        small.step();
        large.step_in_many_launches();
        persistent.step_persistently(false, k_numbers_of_groups[i % k_numbers_of_groups.size()]);
        ASSERT_TRUE(small.motion() == large.motion()) << "step " << i;
        ASSERT_TRUE(persistent.motion() == large.motion()) << "step " << i;
    }
}

TALUS_ON_EVERY_DEVICE(Determinism);
// A hybrid world's resolution is that of the CPU.
INSTANTIATE_TEST_SUITE_P(Devices, Paths, testing::Values(DeviceKind::Cpu, DeviceKind::Gpu),
                         [](const auto& test) { return name_of(test.param); });

TEST(Threads, any_number_ends_in_the_same_bits) {
    for (const Case& c : k_cases) {
        const std::uint64_t expected = hash_on_one_thread(c);
        for (const std::uint32_t threads : {2u, 3u, 8u}) {
            WorldOptions options = options_on(DeviceKind::Cpu);
            options.threads = threads;
            EXPECT_EQ(hash_of(options, c), expected) << c.scene << ", " << threads << " threads";
        }
    }
}

/// What hash_of_scene prints, with so many threads for llvmpipe.
std::string hash_in_child(const Case& c, int driver_threads, const char* broad_phase = "") {
    const std::string command = "LP_NUM_THREADS=" + std::to_string(driver_threads) + " '" TALUS_HASH_PROGRAM "' " +
                                c.scene + " " + std::to_string(c.steps) + " " + broad_phase;
    std::FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return "no process";
    std::array<char, 64> text{};
    const std::size_t length = std::fread(text.data(), 1, text.size(), pipe);
    const int status = pclose(pipe);
    return status == 0 ? std::string(text.data(), length) : "exit status " + std::to_string(status);
}

class DriverThreads : public testing::TestWithParam<DeviceKind> {};

TEST_P(DriverThreads, do_not_change_the_bits) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    // llvmpipe with threads of its own runs work groups at the same time, as hardware does.
    for (const Case& c : {Case{"pool:boxes=70", 40}, Case{"grid:stacks=230", 5}}) {
        std::array<char, 32> expected{};
        std::snprintf(expected.data(), expected.size(), "%016llx\n",
                      static_cast<unsigned long long>(hash_on_one_thread(c)));
        EXPECT_EQ(hash_in_child(c, 0), expected.data()) << c.scene;
        EXPECT_EQ(hash_in_child(c, 2), expected.data()) << c.scene;
        EXPECT_EQ(hash_in_child(c, 2, "bvh"), expected.data()) << c.scene << ", with the tree";
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, DriverThreads, testing::Values(DeviceKind::Gpu),
                         [](const auto& test) { return name_of(test.param); });

} // namespace
} // namespace talus::tests
