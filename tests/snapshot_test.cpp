// SPDX-License-Identifier: MIT
// Snapshots: stepping forward again gives the same bits, on each device and from one to another, whatever was done to
// the world in between; files that say what is wrong with them.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zstd.h>

#include "devices.h"
#include "parameters.h"
#include "scenes/scene.h"
#include "state/formulas.h"

namespace talus::tests {
namespace {

std::vector<BodyId> fill(World& world, const std::string& specification) {
    std::vector<BodyDefinition> definitions;
    for (const scenes::NamedBody& body : scenes::make_scene(specification).bodies)
        definitions.push_back(body.definition);
    return world.add(definitions);
}

std::vector<std::uint64_t> hashes_of_steps(World& world, int count) {
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < count; ++i) {
        world.step();
        hashes.push_back(world.state_hash());
    }
    return hashes;
}

/// All that the world tells of its last step but how long it took.
std::string results_of(const World& world) {
    std::string text;
    const auto add = [&](auto... values) { ((text += std::to_string(values) + " "), ...); };
    const StepReport report = world.report();
    add(report.step, report.pairs, report.manifolds, report.contacts, report.colours, report.substeps);
    for (const CollisionPair& pair : world.collision_pairs())
        add(pair.a.index, pair.b.index);
    for (const Contact& contact : world.contacts()) {
        add(contact.a.index, contact.b.index, contact.colour, contact.normal.x, contact.normal.y, contact.normal.z);
        for (const ContactPoint& point : contact.points)
            add(point.position.x, point.position.y, point.position.z, point.separation, point.normal_impulse);
    }
    return text;
}

BodyDefinition ball_above() {
    BodyDefinition ball;
    ball.shape = Sphere{0.3f};
    ball.pose.position = {0.0f, 9.0f, 0.0f};
    return ball;
}

/// Of a stack that sleeps, in a world that has just got other settings: these wake all bodies in the next step.
Snapshot snapshot_before_waking(World& world) {
    fill(world, "stack:height=2");
    Settings settings = world.settings();
    settings.sleeping = true;
    world.set_settings(settings);
    world.step(200);
    EXPECT_EQ(world.report().sleeping_bodies, 2u);
    settings.gravity = {1.0f, -9.81f, 0.0f};
    world.set_settings(settings);
    return world.snapshot();
}

class SnapshotOnDevice : public OnDevice {};
TALUS_ON_EVERY_DEVICE(SnapshotOnDevice);

} // namespace

TEST_P(SnapshotOnDevice, stepping_forward_again_gives_the_same_bits) {
    World world = make_world();
    fill(world, "pool:boxes=60");
    world.step(70); // boxes have met, and more will
    const Snapshot before = world.snapshot();
    EXPECT_EQ(before.step(), 70u);
    EXPECT_EQ(before.body_count(), world.body_count());
    const std::uint64_t hash = world.state_hash();
    const std::string results = results_of(world);
    const auto first = hashes_of_steps(world, 10);

    world.restore(before);
    EXPECT_EQ(world.step_count(), 70u);
    EXPECT_EQ(world.state_hash(), hash);
    EXPECT_EQ(results_of(world), results);
    EXPECT_EQ(hashes_of_steps(world, 10), first);

    // From what was restored another snapshot is as good.
    world.restore(before);
    const Snapshot again = world.snapshot();
    world.step(3);
    world.restore(again);
    EXPECT_EQ(hashes_of_steps(world, 10), first);
}

TEST_P(SnapshotOnDevice, goes_on_with_other_bodies_as_the_world_would) {
    // What a body had of its hits is no other's, whose slot comes to lie there when there are more bodies.
    const auto ball_at = [](float x, float y) {
        BodyDefinition ball;
        ball.shape = Sphere{0.5f};
        ball.pose.position = {x, y, 0.0f};
        ball.velocity.linear = {0.0f, -5.0f, 0.0f};
        ball.material.restitution = 0.8f;
        return ball;
    };
    for (const int start : {2, 15, 33}) {
        World world = make_world(), other = make_world();
        BodyDefinition floor;
        floor.kind = BodyKind::Static;
        floor.shape = Box{{50.0f, 1.0f, 50.0f}};
        floor.pose.position = {0.0f, -1.0f, 0.0f};
        world.add(floor);
        const BodyId first = world.add(ball_at(0.0f, 3.0f + 0.037f * static_cast<float>(start)));
        for (int i = 0; i < 200 && !(world.velocity(first).linear.y > 0.0f); ++i)
            world.step(); // until it has just been hit
        other.restore(world.snapshot());
        world.add(ball_at(5.0f, 3.0f));
        other.add(ball_at(5.0f, 3.0f));
        EXPECT_EQ(hashes_of_steps(other, 40), hashes_of_steps(world, 40)) << start;
    }
}

TEST_P(SnapshotOnDevice, wakes_whom_the_next_step_was_to_wake) {
    World world = make_world();
    const Snapshot between = snapshot_before_waking(world);
    const auto first = hashes_of_steps(world, 3);
    EXPECT_EQ(world.report().sleeping_bodies, 0u);
    world.restore(between);
    EXPECT_EQ(hashes_of_steps(world, 3), first);
}

TEST_P(SnapshotOnDevice, keeps_a_contact_of_bodies_so_far_apart_that_none_would_begin) {
    Settings weightless;
    weightless.gravity = {0.0f, 0.0f, 0.0f};
    const float gap = engine::make_parameters(weightless, {}).speculative_distance - 1.0e-4f; // m
    const auto add_boxes = [](World& world, float apart) {
        BodyDefinition below, above;
        below.kind = BodyKind::Static;
        above.pose.position = {0.0f, 1.0f + apart, 0.0f};
        above.velocity.linear = {0.0f, 3.0e-3f, 0.0f}; // 0.05 mm a step
        world.add(std::vector{below, above});
    };
    World world = make_world(weightless), restored = make_world(weightless), later = make_world(weightless);
    add_boxes(world, gap);
    world.step(5);
    ASSERT_EQ(world.report().manifolds, 1u);
    restored.restore(world.snapshot());
    add_boxes(later, gap + 5 * 5.0e-5f);
    later.step();
    EXPECT_EQ(later.report().manifolds, 0u) << "so a contact there lasts, but does not begin";
    for (int step = 5; step < 12; ++step) {
        world.step();
        restored.step();
        EXPECT_EQ(restored.report().manifolds, world.report().manifolds) << step;
        EXPECT_EQ(restored.state_hash(), world.state_hash()) << step;
        if (step == 5) {
            EXPECT_EQ(world.report().manifolds, 1u);
        }
    }
    EXPECT_EQ(world.report().manifolds, 0u);
}

TEST_P(SnapshotOnDevice, lets_a_body_in_a_used_slot_sleep_as_the_world_would) {
    Settings sleeping;
    sleeping.sleeping = true;
    World world = make_world(sleeping), other = make_world(sleeping);
    const BodyId top = fill(world, "stack:height=3").back();
    const BodyDefinition again = scenes::make_scene("stack:height=3").bodies.back().definition;
    world.step(10);
    world.remove(top); // at the end, so that the slot is given up
    world.step(2);
    other.restore(world.snapshot());
    for (World* each : {&world, &other}) {
        each->step(3);
        each->add(again);
    }
    for (int i = 0; i < 60; ++i) {
        world.step();
        other.step();
        ASSERT_EQ(world.report().sleeping_bodies, other.report().sleeping_bodies) << "step " << i;
        ASSERT_EQ(world.state_hash(), other.state_hash()) << "step " << i;
    }
    EXPECT_EQ(world.report().sleeping_bodies, 3u);
}

TEST_P(SnapshotOnDevice, undoes_what_was_done_to_the_world) {
    World world = make_world();
    const std::vector<BodyId> ids = fill(world, "pyramid:base=5");
    world.step(5);
    world.add_force(ids[7], {0.0f, 0.0f, 900.0f}); // waits for the next step
    const Snapshot before = world.snapshot();
    const auto first = hashes_of_steps(world, 5);

    Settings settings = world.settings();
    settings.gravity = {0.0f, -1.0f, 0.0f};
    world.set_settings(settings);
    world.remove(ids[3]);
    world.step();
    const BodyId extra = world.add(ball_above());
    Material smooth;
    smooth.friction = 0.0f;
    world.set_material(ids[5], smooth);
    world.step(3);

    world.restore(before);
    EXPECT_EQ(world.settings().gravity, (Vec3{0.0f, -9.81f, 0.0f}));
    EXPECT_TRUE(world.contains(ids[3]));
    EXPECT_FALSE(world.contains(extra));
    EXPECT_EQ(world.material(ids[5]).friction, 0.5f);
    EXPECT_EQ(hashes_of_steps(world, 5), first);
    // An id that was given out is not given out again.
    const BodyId later = world.add(ball_above());
    EXPECT_NE(later, extra);
    world.remove(ids[3]);
    world.step();
    const BodyId in_its_place = world.add(ball_above());
    EXPECT_NE(in_its_place, extra);
    EXPECT_NE(in_its_place, ids[3]);
}

TEST_P(SnapshotOnDevice, goes_to_a_world_on_another_device) {
    World world = World({}, options_on(DeviceKind::Cpu));
    const std::vector<BodyId> ids = fill(world, "pool:boxes=40");
    world.step(60);
    const Snapshot snapshot = world.snapshot();
    World other = make_world(); // empty, and with little room
    other.restore(snapshot);
    EXPECT_EQ(other.bodies(), ids);
    EXPECT_EQ(other.mass(ids.back()), world.mass(ids.back()));
    EXPECT_EQ(results_of(other), results_of(world));
    EXPECT_EQ(hashes_of_steps(other, 5), hashes_of_steps(world, 5));
}

TEST_P(SnapshotOnDevice, of_a_world_before_its_first_step) {
    World world = make_world();
    fill(world, "stack:height=3");
    const Snapshot start = world.snapshot();
    const auto first = hashes_of_steps(world, 3);
    world.restore(start);
    EXPECT_EQ(world.step_count(), 0u);
    EXPECT_TRUE(world.contacts().empty());
    EXPECT_EQ(hashes_of_steps(world, 3), first);
}

TEST_P(SnapshotOnDevice, sensors_and_contact_events_go_on_as_they_did) {
    World world = make_world();
    fill(world, "pool:boxes=40");
    BodyDefinition sensor = ball_above();
    sensor.kind = BodyKind::Static;
    sensor.sensor = true;
    sensor.shape = Sphere{3.0f};
    sensor.pose.position = {0.0f, 1.0f, 0.0f};
    const BodyId watcher = world.add(sensor);
    world.watch_contacts(ContactWatch::All);
    world.step(60);
    world.take_contact_events();
    const Snapshot before = world.snapshot();
    const std::string results = results_of(world);
    const auto events_of_steps = [&] {
        std::string text;
        world.step(8);
        for (const ContactEvent& event : world.take_contact_events()) {
            for (const std::uint64_t value : {event.step, static_cast<std::uint64_t>(event.phase),
                                              std::uint64_t{event.a.index}, std::uint64_t{event.b.index}})
                text += std::to_string(value) + " ";
            text += event.sensor ? "sensor\n" : "\n";
        }
        return text;
    };
    const std::string first = events_of_steps();
    EXPECT_NE(first.find("sensor"), std::string::npos);
    world.remove(watcher);
    world.step(2); // their events are not taken
    world.restore(before);
    EXPECT_EQ(results_of(world), results);
    EXPECT_EQ(events_of_steps(), first);

    before.save(std::filesystem::path(testing::TempDir()) / "talus_sensor.snapshot");
    const Snapshot loaded = Snapshot::load(std::filesystem::path(testing::TempDir()) / "talus_sensor.snapshot");
    world.restore(loaded);
    EXPECT_EQ(events_of_steps(), first);
    // Where nobody watched, the contacts that there are begin.
    World other = make_world();
    other.restore(before);
    const Snapshot unwatched = other.snapshot();
    world.restore(unwatched);
    EXPECT_EQ(results_of(world), results);
    world.step();
    for (const ContactEvent& event : world.take_contact_events())
        EXPECT_EQ(event.phase, ContactPhase::Begin);
}

TEST_P(SnapshotOnDevice, poses_that_come_without_waiting_begin_anew) {
    World world = make_world();
    const std::vector<BodyId> ids = fill(world, "stack:height=3");
    world.keep_poses_coming(true);
    world.step(4);
    const Snapshot before = world.snapshot();
    world.step(4);
    world.restore(before);
    EXPECT_TRUE(world.newest_poses().bodies.empty());
    world.step();
    world.wait();
    const World::PoseFrame frame = world.newest_poses();
    EXPECT_EQ(frame.step, 5u);
    EXPECT_EQ(frame.bodies, ids);
    EXPECT_EQ(frame.poses, world.poses());
}

// ---- files ----

class SnapshotFile : public testing::Test {
protected:
    SnapshotFile() { std::filesystem::create_directories(folder); }
    ~SnapshotFile() override { std::filesystem::remove_all(folder); }

    static std::string content_of(const std::filesystem::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    /// A file of a fresh world in which a stack has stood for a while.
    std::string saved_stack(World& world) const {
        fill(world, "stack:height=4");
        world.step(30);
        world.snapshot().save(file);
        return content_of(file);
    }
    std::string error_of_content(const std::string& content) const {
        std::ofstream(file, std::ios::binary) << content;
        return error_of([&] { Snapshot::load(file); });
    }

    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / ("talus_snapshot_" + std::to_string(getpid()));
    const std::filesystem::path file = folder / "a.snapshot";
};

TEST_F(SnapshotFile, brings_a_world_back_that_has_given_up_slots) {
    World world({}, options_on(DeviceKind::Cpu));
    const std::vector<BodyId> ids = fill(world, "pool:boxes=40");
    world.step(60);
    for (const std::size_t last : {ids.size() - 1, ids.size() - 2, std::size_t{20}, std::size_t{10}})
        world.remove(ids[last]);
    world.step(2);
    world.snapshot().save(file);
    World other({}, options_on(DeviceKind::Cpu));
    other.restore(Snapshot::load(file));
    EXPECT_EQ(results_of(other), results_of(world));
    EXPECT_FALSE(other.contains(ids.back()));
    for (const std::size_t slot : {std::size_t{10}, std::size_t{20}, ids.size() - 2, ids.size() - 1}) {
        const BodyId id = world.add(ball_above());
        EXPECT_EQ(id.index, slot);
        EXPECT_EQ(id.generation, 1u);
        EXPECT_EQ(other.add(ball_above()), id);
    }
    EXPECT_EQ(hashes_of_steps(other, 3), hashes_of_steps(world, 3));
}

TEST_F(SnapshotFile, brings_a_world_back) {
    World world({}, options_on(DeviceKind::Cpu));
    const std::vector<BodyId> ids = fill(world, "pool:boxes=40");
    world.step(60);
    world.remove(ids[30]);
    world.snapshot().save(file);
    World other({}, options_on(DeviceKind::Cpu));
    other.restore(Snapshot::load(file));
    EXPECT_EQ(other.bodies(), world.bodies());
    EXPECT_EQ(results_of(other), results_of(world));
    world.step();
    other.step();
    EXPECT_EQ(other.state_hash(), world.state_hash());
    const BodyDefinition box;
    EXPECT_EQ(other.add(box), world.add(box));
    // Nothing but the file is left.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(SnapshotFile, says_that_bodies_are_to_wake) {
    World world({}, options_on(DeviceKind::Cpu)), other({}, options_on(DeviceKind::Cpu));
    snapshot_before_waking(world).save(file);
    other.restore(Snapshot::load(file));
    EXPECT_EQ(hashes_of_steps(other, 3), hashes_of_steps(world, 3));
}

TEST_F(SnapshotFile, says_what_is_wrong) {
    World world({}, options_on(DeviceKind::Cpu));
    const std::string good = saved_stack(world);
    const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };

    EXPECT_TRUE(has(error_of([&] { Snapshot::load(folder / "none"); }), "there is no such file"));
    EXPECT_TRUE(has(error_of([&] { Snapshot::load(folder); }), "is not a file"));
    EXPECT_TRUE(has(error_of_content("hello"), "is not a Talus snapshot"));
    EXPECT_TRUE(has(error_of_content(good.substr(0, 10)), "ends early"));
    std::string other_version = good;
    other_version[8] = 99;
    EXPECT_TRUE(has(error_of_content(other_version), "version 99"));
    // Cut anywhere, or one bit turned anywhere: never taken for another snapshot. (A few bits of Zstandard's frame mean
    // nothing.)
    for (std::size_t i = 12; i < good.size(); i += 7) {
        EXPECT_TRUE(has(error_of_content(good.substr(0, i)), "is damaged")) << i;
        std::string damaged = good;
        damaged[i] = static_cast<char>(damaged[i] ^ 16);
        const std::string error = error_of_content(damaged);
        if (error == "no error") {
            Snapshot::load(file).save(file);
            EXPECT_EQ(content_of(file), good) << i;
        } else {
            EXPECT_TRUE(has(error, "is damaged")) << i << ": " << error;
        }
    }
    EXPECT_EQ(error_of_content(good), "no error");

    EXPECT_TRUE(has(error_of([&] { world.snapshot().save(folder / "no folder" / "a"); }), "cannot be written"));
    EXPECT_TRUE(has(error_of([&] { world.snapshot().save(folder); }), "is not a file"));
}

// What a file says of a load is what steps reckon with: one that none can have is told apart from a file that is whole.
TEST_F(SnapshotFile, refuses_loads_that_none_can_have) {
    World world({}, options_on(DeviceKind::Cpu));
    const std::string good = saved_stack(world);
    constexpr std::size_t k_head = 12;
    std::string state(ZSTD_getFrameContentSize(good.data() + k_head, good.size() - k_head), '\0');
    ASSERT_EQ(ZSTD_decompress(state.data(), state.size(), good.data() + k_head, good.size() - k_head), state.size());
    // The list of manifolds: the size of a record, and how many there are.
    std::string list_head(12, '\0');
    const std::uint32_t stride = sizeof(engine::Manifold);
    const std::uint64_t count = world.report().pairs;
    std::memcpy(list_head.data(), &stride, sizeof stride);
    std::memcpy(list_head.data() + sizeof stride, &count, sizeof count);
    const std::size_t manifolds = state.find(list_head) + list_head.size();
    ASSERT_EQ(state.find(list_head, manifolds), std::string::npos) << "it is that list";

    const auto error_with = [&](std::size_t member, auto value) {
        std::string changed = state;
        std::memcpy(changed.data() + manifolds + member, &value, sizeof value);
        std::string packed(ZSTD_compressBound(changed.size()), '\0');
        packed.resize(ZSTD_compress(packed.data(), packed.size(), changed.data(), changed.size(), 1));
        return error_of_content(good.substr(0, k_head) + packed);
    };
    const std::size_t weights = offsetof(engine::Manifold, weights),
                      lasting = offsetof(engine::Manifold, lasting_weights);
    const std::size_t demand = offsetof(engine::Manifold, demand);
    EXPECT_EQ(error_with(weights, 3.0f), "no error");
    const std::string wrong_load = "a manifold has a load that none can have";
    for (const float load : {-1.0f, std::nanf("")}) {
        EXPECT_NE(error_with(weights, load).find(wrong_load), std::string::npos) << load;
        EXPECT_NE(error_with(lasting, load).find(wrong_load), std::string::npos) << load;
    }
    EXPECT_EQ(error_with(demand, engine::make_demand(8, engine::k_growing + 7, 0, 1)), "no error");
    EXPECT_NE(error_with(demand, engine::make_demand(8, engine::k_growing + 9, 0, 1)).find(wrong_load),
              std::string::npos);
    EXPECT_NE(error_with(demand, engine::make_demand(1001, 0, 0, 1)).find("not one of its bodies"), std::string::npos);
}

} // namespace talus::tests
