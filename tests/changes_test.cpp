// SPDX-License-Identifier: MIT
// Bodies that come, go and change while steps are on their way: it costs bytes for what changes and nothing for the
// rest of the world, nobody waits, and the bits are those of a world that waits after every step.
#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

constexpr int k_churn = 10; // bodies removed and added before each step

/// Boxes that touch nothing.
std::vector<BodyDefinition> scattered(int count) {
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < count; ++i)
        bodies.push_back(box_at({3.0f * static_cast<float>(i % 50), 0.0f, 3.0f * static_cast<float>(i / 50)}));
    return bodies;
}

class Changes : public OnDevice {
protected:
    World tiny_world() const {
        WorldOptions options = options_on(GetParam());
        options.capacities = {1, 1, 1};
        return World({}, options);
    }
};

TEST_P(Changes, cost_bytes_for_what_changes_and_no_wait) {
    std::vector<Transfers> costs;
    for (const int bodies : {100, 2'000}) {
        World world = make_world(weightless());
        std::vector<BodyId> ids = world.add(scattered(bodies));
        world.step();
        world.wait();
        const Transfers before = world.transfers();
        for (int step = 0; step < 5; ++step) {
            for (int i = 0; i < k_churn; ++i) {
                const std::size_t which = static_cast<std::size_t>(k_churn * step + i);
                world.remove(ids[which]);
                ids.push_back(world.add(box_at({static_cast<float>(-3 * i), 3.0f, static_cast<float>(-3 * step)})));
            }
            world.add_force(ids.back(), {1.0f, 0.0f, 0.0f});
            world.set_gravity_scale(ids.back(), 0.5f);
            world.step();
        }
        const Transfers after = world.transfers();
        costs.push_back(
            {after.to_device - before.to_device, after.to_host - before.to_host, after.waits - before.waits});
        EXPECT_EQ(world.body_count(), static_cast<std::size_t>(bodies));
    }
    EXPECT_GT(costs[0].to_device, 0u);
    EXPECT_LT(costs[0].to_device, 5u * k_churn * 400u); // all records of a body are 160 bytes
    for (const Transfers& cost : costs) {
        EXPECT_EQ(cost.to_device, costs[0].to_device);
        EXPECT_EQ(cost.to_host, 0u);
        EXPECT_EQ(cost.waits, 0u);
    }
}

TEST_P(Changes, behind_steps_that_are_made_again_give_the_same_bits) {
    // In the first world several steps are on their way, each with changes, when one of them turns out not to fit.
    World hasty = tiny_world(), patient = make_world();
    std::vector<BodyId> ids;
    for (World* world : {&hasty, &patient}) {
        ids.clear();
        ids.push_back(world->add(ground()));
        for (int i = 0; i < 40; ++i) {
            const float x = 1.05f * static_cast<float>(i % 4), z = 1.05f * static_cast<float>(i / 4 % 3);
            ids.push_back(world->add(box_at({x, 0.5f + 1.02f * static_cast<float>(i / 12), z})));
            world->add_force(ids.back(), {20'000.0f, 0.0f, 0.0f});
            if (i % 5 == 4) world->remove(ids[static_cast<std::size_t>(i - 2)]);
            if (i % 7 == 6) world->set_material(ids[static_cast<std::size_t>(i)], {0.1f, 0.0f});
            world->step(2);
            if (world == &patient) world->wait();
        }
    }
    EXPECT_GT(hasty.report().growths, 1u);
    EXPECT_EQ(hasty.body_count(), 33u);
    EXPECT_EQ(hasty.state_hash(), patient.state_hash());
}

TEST_P(Changes, that_no_step_has_seen_yet_survive_a_look_at_the_world) {
    World world = make_world(weightless());
    const BodyId first = world.add(box_at({}));
    world.step(3);
    BodyDefinition late = box_at({5.0f, 0.0f, 0.0f});
    late.velocity.linear.y = 60.0f;
    const BodyId second = world.add(late);
    const BodyId third = world.add(box_at({10.0f, 0.0f, 0.0f}));
    world.remove(third);
    world.add_force(first, {6'000.0f, 0.0f, 0.0f});
    EXPECT_EQ(world.pose(first).position.x, 0.0f); // reads all bodies
    EXPECT_EQ(world.pose(second).position.x, 5.0f);
    EXPECT_EQ(world.velocity(second).linear.y, 60.0f);
    world.step();
    EXPECT_NEAR(world.pose(second).position.y, 1.0f, 1e-4f);
    EXPECT_NEAR(world.velocity(first).linear.x, 0.1f, 1e-4f); // 6 kN on a tonne for a sixtieth of a second
    world.step();
    EXPECT_NEAR(world.velocity(first).linear.x, 0.1f, 1e-4f); // the force is used up
    EXPECT_EQ(world.body_count(), 2u);
}

TEST_P(Changes, of_a_force_add_up_also_where_the_buffers_are_looked_at_in_between) {
    if (!has_gl()) return; // there are none
    World world = make_world(weightless());
    const BodyId box = world.add(box_at({}));
    world.step();
    world.add_force(box, {6'000.0f, 0.0f, 0.0f});
    world.gl_buffers();
    world.add_force(box, {6'000.0f, 0.0f, 0.0f});
    world.step(2);
    EXPECT_NEAR(world.velocity(box).linear.x, 0.2f, 1e-4f);
}

TEST_P(Changes, of_forces_have_room_from_the_first_force_on) {
    constexpr int count = 2'000;
    World world = make_world(weightless());
    const std::vector<BodyId> ids = world.add(scattered(count));
    world.step(); // which all that comes new needs
    for (const BodyId id : ids)
        world.set_velocity(id, {{0.0f, 1.0f, 0.0f}, {}});
    world.step();
    const std::uint64_t before = world.memory().device;
    const float mass = world.mass(ids.back());
    for (int i = 1; i <= 2; ++i) {
        world.add_force(ids.back(), {60.0f * mass, 0.0f, 0.0f});
        world.step();
        EXPECT_NEAR(world.velocity(ids.back()).linear.x, static_cast<float>(i), 1e-4f);
        EXPECT_EQ(world.velocity(ids.front()).linear.x, 0.0f);
    }
    const std::uint64_t with_forces = world.memory().device;
    EXPECT_GE(with_forces, before + (count - 1) * 32u) << "velocities alone have needed none";
    EXPECT_LT(with_forces, before + 3 * count * 32u);
    std::vector<BodyId> more = world.add(scattered(3 * count));
    world.add_torque(more.back(), {0.0f, mass, 0.0f});
    world.step();
    EXPECT_NE(world.velocity(more.back()).angular.y, 0.0f) << "there is room for the bodies that have come since";
    EXPECT_GE(world.memory().device, with_forces + 3u * count * 32u);
}

TEST(BodyTables, give_each_changed_record_once_and_in_order) {
    using engine::BufferId, engine::uint;
    engine::BodyTable table;
    constexpr uint count = 40;
    for (uint i = 0; i < count; ++i)
        table.add(box_at({static_cast<float>(i), 0.0f, 0.0f}));
    std::vector<uint> all(count);
    std::iota(all.begin(), all.end(), 0u);
    const auto slots_of = [](const engine::BodyChanges& changes, BufferId buffer) {
        const auto found = std::ranges::find(changes, buffer, &engine::RecordChanges::buffer);
        return found == changes.end() ? std::vector<uint>() : found->slots;
    };
    const engine::BodyChanges first = table.take_changes(false);
    for (const BufferId buffer : {BufferId::Poses, BufferId::Velocities, BufferId::Shapes, BufferId::Properties})
        EXPECT_EQ(slots_of(first, buffer), all);
    EXPECT_EQ(first.size(), 4u) << "no loads";
    EXPECT_TRUE(table.take_changes(true).empty());
    const std::vector<uint> moved{39, 0, 7, 6, 8, 10, 38, 20}, pushed{8, 9, 7, 39, 21};
    for (const uint slot : moved)
        table.mark(slot, engine::k_dirty_pose | engine::k_dirty_contacts);
    for (const uint slot : pushed)
        table.mark(slot, engine::k_dirty_velocity | engine::k_dirty_load);
    const engine::BodyChanges second = table.take_changes(true);
    EXPECT_EQ(slots_of(second, BufferId::Poses), (std::vector<uint>{0, 6, 7, 8, 10, 20, 38, 39}));
    EXPECT_EQ(slots_of(second, BufferId::Velocities), (std::vector<uint>{7, 8, 9, 21, 39}));
    EXPECT_EQ(slots_of(second, BufferId::Loads), (std::vector<uint>{7, 8, 9, 21, 39}));
    EXPECT_EQ(slots_of(second, BufferId::Starts), slots_of(second, BufferId::Poses));
    EXPECT_TRUE(second.back().records.empty()) << "the slots say it all";
    EXPECT_EQ(second.size(), 4u);
    const engine::RecordChanges& poses = second.front();
    ASSERT_EQ(poses.records.size(), moved.size() * sizeof(engine::BodyPose));
    for (std::size_t i = 0; i < poses.slots.size(); ++i) {
        engine::BodyPose pose;
        std::memcpy(&pose, poses.records.data() + i * sizeof pose, sizeof pose);
        EXPECT_EQ(pose.position.x, static_cast<float>(poses.slots[i]));
    }
}

TEST(BodyTables, stay_as_they_are_where_no_body_is_added) {
    engine::BodyTable table;
    const std::vector<BodyId> ids = table.add(scattered(3));
    table.remove(ids[0]);
    table.recycle();
    EXPECT_TRUE(table.add(std::span<const BodyDefinition>()).empty());
    EXPECT_EQ(table.slot_count(), 3u);
    EXPECT_EQ(table.body_count(), 2u);
    EXPECT_EQ(table.add(scattered(1).front()).index, 0u) << "the free slot still is";
}

/// Twice as many as are worth other threads, in slots of their own and in those that others have left.
TEST(BodyTables, of_many_bodies_are_those_of_one_after_the_other) {
    using engine::uint;
    constexpr uint count = 20'000, removed = 500;
    std::vector<BodyDefinition> bodies = scattered(count);
    for (uint i = 0; i < count; ++i) {
        if (i % 3 == 0) bodies[i].kind = BodyKind::Kinematic;
        if (i % 5 == 0) bodies[i].material.restitution = 0.5f;
        bodies[i].mass = static_cast<float>(1 + i % 7);
    }
    engine::BodyTable one_by_one, together;
    for (engine::BodyTable* const table : {&one_by_one, &together}) {
        const std::vector<BodyId> first = table->add(std::span(bodies).first(removed));
        table->add(bodies[0]); // it stays, as slots at the end would be gone
        for (const BodyId id : first)
            table->remove(id);
        table->recycle();
        ASSERT_EQ(table->slot_count(), removed + 1);
    }
    std::vector<BodyId> ids;
    for (const BodyDefinition& body : bodies)
        ids.push_back(one_by_one.add(body));
    EXPECT_EQ(together.add(bodies, 4), ids);
    EXPECT_EQ(ids.front().index, 0u) << "the slots of those that were removed come first";
    EXPECT_EQ(together.slot_count(), count + 1);
    EXPECT_EQ(together.body_count(), one_by_one.body_count());
    EXPECT_EQ(together.kinematic_count, one_by_one.kinematic_count);
    EXPECT_EQ(together.bouncing_count, one_by_one.bouncing_count);
    EXPECT_EQ(together.masses, one_by_one.masses);
    const engine::BodyChanges expected = one_by_one.take_changes(false), changes = together.take_changes(false, 4);
    ASSERT_EQ(changes.size(), expected.size());
    for (std::size_t i = 0; i < changes.size(); ++i) {
        EXPECT_EQ(changes[i].buffer, expected[i].buffer);
        EXPECT_TRUE(changes[i].slots == expected[i].slots) << i;
        EXPECT_TRUE(changes[i].records == expected[i].records) << i;
    }
}

TEST_P(Changes, of_minus_zero_are_no_loads) { // as a file may have them
    EngineRun run(options_on(GetParam()), {ground(), box_at({0.0f, 0.5f, 0.0f})});
    static_cast<void>(run.table.take_changes(run.simulation.has_room_for_loads()));
    run.table.loads[1].force.x = -0.0f;
    run.table.mark(1, engine::k_dirty_load);
    EXPECT_FALSE(run.table.has_loads());
    run.simulation.step(run.table.population(), false, run.table.take_changes(run.simulation.has_room_for_loads()));
    run.simulation.settle();
    EXPECT_EQ(run.simulation.step_count(), 1u);
}

TEST_P(Changes, that_empty_a_world_give_its_slots_back) {
    World world = make_world(weightless());
    const std::vector<BodyId> ids = world.add(scattered(600));
    world.step();
    const std::uint64_t full = world.memory().host;
    for (std::size_t i = 10; i < ids.size(); ++i)
        world.remove(ids[i]);
    world.step(2);
    EXPECT_LT(world.memory().host, full / 20);
    EXPECT_FALSE(world.contains(ids[300]));
    const std::string error = error_of([&] { world.remove(ids[300]); });
    EXPECT_NE(error.find("was removed"), std::string::npos) << error;

    // What comes back has a new generation, and the lowest slots.
    world.remove(ids[4]);
    world.step();
    for (const BodyId id : world.add(scattered(300))) {
        EXPECT_TRUE(world.contains(id));
        EXPECT_NE(id.generation, ids[id.index].generation);
    }
    world.step();
    EXPECT_EQ(world.body_count(), 309u);
    EXPECT_EQ(world.bodies().size(), 309u);
    EXPECT_EQ(world.bodies()[4].index, 4u);
    EXPECT_EQ(world.bodies().back().index, 308u);
    EXPECT_FALSE(world.contains(ids[4]));
}

TALUS_ON_EVERY_DEVICE(Changes);

} // namespace
} // namespace talus::tests
