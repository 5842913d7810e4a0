// SPDX-License-Identifier: MIT
// The first steps of a world on a GPU whose kernels are still being compiled: the CPU makes them, and nobody sees it by
// the bits.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "resolution/resolution.h"
#include "saved_state.h"
#include "step_results.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"
#include "tests/stand_in_device.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::Device;
using engine::ReadRequest;
using engine::uint;

/// A GPU, of which a test says when its kernels are ready.
class SlowDevice final : public StandInDevice {
public:
    using StandInDevice::StandInDevice;

    bool ready = false;
    std::string fault;           // of a kernel that is not ready
    std::set<std::string> given; // kernels that were to be made ready
    std::set<std::string> ran;

    bool make_ready(std::span<const engine::Kernel* const> kernels, std::chrono::milliseconds) override {
        if (!fault.empty()) throw Error(fault);
        for (const engine::Kernel* kernel : kernels)
            given.insert(kernel->path);
        return ready && device->make_ready(kernels, std::chrono::hours(1));
    }
    bool is_ready(const engine::Kernel&) override { return false; } // launches do without those that they can
    void run(const engine::Launch& launch) override {
        ran.insert(launch.kernel.path);
        StandInDevice::run(launch);
    }
    DeviceInfo info() const override {
        DeviceInfo info = device->info();
        info.in_software = false; // else it would have no first steps on the CPU
        return info;
    }
};

/// A run to which bodies come, and whose bodies change, as those of a world.
struct TableRun : EngineRun {
    TableRun(const WorldOptions& options, engine::Devices devices, const Settings& wanted)
        : EngineRun(options, std::move(devices), {}, wanted) {}

    void add(const std::vector<BodyDefinition>& bodies) {
        for (const BodyDefinition& body : bodies)
            table.add(body);
    }

    void step(bool with_poses = false) {
        simulation.reserve_bodies(table.slot_count());
        if (table.has_loads()) simulation.reserve_loads();
        engine::Population population = table.population();
        population.waking = table.take_waking();
        simulation.step(population, with_poses, table.take_changes(simulation.has_room_for_loads()));
        table.forget_loads();
        table.recycle();
        simulation.settle();
    }

    engine::SavedState save() {
        const std::size_t count = table.slot_count();
        simulation.read_state(std::array{
            ReadRequest{BufferId::Poses, count * sizeof(engine::BodyPose), table.poses.data()},
            ReadRequest{BufferId::Velocities, count * sizeof(engine::BodyVelocity), table.velocities.data()}});
        return save_state(simulation, table, settings);
    }

    void restore(const engine::SavedState& saved) {
        simulation.restore(saved);
        simulation.set_settings(saved.settings);
        table.restore(saved.table);
    }

    DeviceKind made_by() const { return simulation.report().device; }
};

/// Of a world on a GPU, or a hybrid one, that does not wait for its kernels.
struct SlowRun : TableRun {
    explicit SlowRun(DeviceKind kind, const Settings& wanted = {}, std::uint32_t threads = 2)
        : SlowRun(options(kind, threads), wanted) {}

    SlowDevice* gpu = nullptr; // the simulation's

private:
    struct Parts {
        WorldOptions options;
        engine::Devices devices;
        SlowDevice* gpu;
    };
    static Parts options(DeviceKind kind, std::uint32_t threads) {
        Parts parts{options_on(kind), {}, nullptr};
        parts.options.threads = threads;
        parts.options.wait_for_kernels = false;
        parts.devices = engine::make_devices(parts.options);
        // The CPU device in the place of a GPU, where there is none.
        auto slow =
            std::make_unique<SlowDevice>(std::move(kind == DeviceKind::Cpu ? parts.devices.cpu : parts.devices.gpu));
        parts.gpu = slow.get();
        parts.devices.gpu = std::move(slow);
        if (kind == DeviceKind::Cpu) parts.devices.kind = DeviceKind::Gpu;
        return parts;
    }
    SlowRun(Parts parts, const Settings& wanted)
        : TableRun(parts.options, std::move(parts.devices), wanted), gpu(parts.gpu) {}
};

/// The same on the CPU throughout.
struct PlainRun : TableRun {
    explicit PlainRun(const Settings& wanted = {})
        : TableRun(options_on(DeviceKind::Cpu), engine::make_devices(options_on(DeviceKind::Cpu)), wanted) {}
};

/// The kind that a step has which the CPU has not made in another's place.
DeviceKind kind_of(DeviceKind parameter) {
    return parameter == DeviceKind::Cpu ? DeviceKind::Gpu : parameter;
}

/// Those since the last call, in an order of their own, as numbers.
std::vector<std::vector<uint>> reports_of(engine::Simulation& simulation) {
    std::vector<std::vector<uint>> all;
    for (const engine::Simulation::StepReports& step : simulation.take_reports()) {
        for (const engine::ContactReport& report : step.reports) {
            std::vector<uint>& words = all.emplace_back(sizeof report / sizeof(uint));
            std::memcpy(words.data(), &report, sizeof report);
        }
    }
    std::ranges::sort(all);
    return all;
}

std::vector<BodyDefinition> with_a_platform(std::vector<BodyDefinition> bodies) {
    BodyDefinition& platform = bodies.emplace_back();
    platform.kind = BodyKind::Kinematic;
    platform.pose.position = {0.7f, 1.0f, 0.0f};
    platform.velocity.linear = {-1.0f, 0.0f, 0.0f};
    return bodies;
}

class FirstSteps : public OnDevice {};

TEST_P(FirstSteps, are_made_by_the_cpu_with_the_same_bits) {
    const std::vector<std::pair<std::vector<BodyDefinition>, Settings>> worlds{
        {bodies_of("pool:boxes=20"), {}},   {with_restitution(bodies_of("pool:boxes=20"), 0.4f), {}},
        {bodies_of("pile:boxes=1100"), {}}, {bodies_of("columns:side=20,height=3"), {}},
        {plate_of(7), with_hubs()},         {with_a_platform(bodies_of("stack:height=3")), {}},
    };
    for (std::size_t w = 0; w < worlds.size(); ++w) {
        for (const int steps_on_cpu : {1, 2, 9}) {
            SCOPED_TRACE(testing::Message() << "world " << w << ", " << steps_on_cpu << " steps on the CPU");
            const auto& [bodies, settings] = worlds[w];
            SlowRun slow(GetParam(), settings);
            PlainRun plain(settings);
            for (TableRun* run : std::array<TableRun*, 2>{&slow, &plain}) {
                run->add(bodies);
                run->simulation.watch_contacts(ContactWatch::Changes);
            }
            for (int i = 0; i < 14; ++i) {
                slow.gpu->ready = i >= steps_on_cpu;
                slow.step();
                plain.step();
                EXPECT_EQ(slow.made_by(), i < steps_on_cpu ? DeviceKind::Cpu : kind_of(GetParam()));
                EXPECT_EQ(slow.gpu->ran.empty(), i < steps_on_cpu) << "step " << i;
                ASSERT_TRUE(slow.motion() == plain.motion()) << "step " << i;
                ASSERT_TRUE(read_contacts(slow.simulation).impulses == read_contacts(plain.simulation).impulses);
                ASSERT_EQ(reports_of(slow.simulation), reports_of(plain.simulation)) << "step " << i;
            }
            EXPECT_EQ(slow.simulation.report().manifolds, plain.simulation.report().manifolds);
        }
    }
}

TEST_P(FirstSteps, are_the_gpus_where_its_kernels_are_there) {
    SlowRun run(GetParam());
    run.add(bodies_of("stack:height=3"));
    run.gpu->ready = true;
    run.step();
    EXPECT_EQ(run.made_by(), kind_of(GetParam()));
    EXPECT_FALSE(run.gpu->ran.empty());
}

TEST_P(FirstSteps, begin_with_what_the_caller_has_done_before) {
    PlainRun plain;
    plain.add(bodies_of("pool:boxes=20"));
    for (int i = 0; i < 40; ++i)
        plain.step();
    const engine::SavedState saved = plain.save();

    SlowRun slow(GetParam());
    slow.gpu->ready = true; // so that bodies can be given to it
    slow.restore(saved);
    slow.simulation.reserve_bodies(slow.table.slot_count());
    slow.simulation.change_bodies(slow.table.population(),
                                  slow.table.take_changes(slow.simulation.has_room_for_loads())); // as before drawing
    slow.gpu->ready = false;
    for (int i = 0; i < 6; ++i) {
        slow.gpu->ready = i >= 3;
        slow.step();
        plain.step();
        ASSERT_TRUE(slow.motion() == plain.motion()) << "step " << i;
    }
    EXPECT_EQ(slow.made_by(), kind_of(GetParam()));
}

TEST_P(FirstSteps, let_sleep_what_rests) {
    Settings sleeping;
    sleeping.sleeping = true;
    for (const int steps_on_cpu : {20, 50}) {
        SlowRun slow(GetParam(), sleeping);
        PlainRun plain(sleeping);
        std::vector<BodyId> tops;
        for (TableRun* run : std::array<TableRun*, 2>{&slow, &plain}) {
            run->add(bodies_of("stack:height=3"));
            tops.push_back(run->table.add(box_at({0.0f, 3.5f, 0.0f})));
        }
        for (int i = 0; i < 90; ++i) {
            if (i == 12) { // whose slot is given up, and used again after the first of these changes of device
                slow.table.remove(tops[0]);
                plain.table.remove(tops[1]);
            }
            if (i == 80) {
                EXPECT_EQ(plain.simulation.report().sleeping_bodies, 4u);
            }
            if (i == 22 || i == 80) {
                for (TableRun* run : std::array<TableRun*, 2>{&slow, &plain})
                    run->add({box_at({0.0f, i == 22 ? 3.5f : 4.6f, 0.0f})});
            }
            slow.gpu->ready = i >= steps_on_cpu;
            slow.step();
            plain.step();
            ASSERT_TRUE(slow.motion() == plain.motion()) << "step " << i;
            ASSERT_EQ(slow.simulation.report().sleeping_bodies, plain.simulation.report().sleeping_bodies);
        }
        EXPECT_LT(plain.simulation.report().sleeping_bodies, 4u) << "woken by what has been put above them";
    }
}

TEST_P(FirstSteps, end_only_when_all_is_ready_that_the_world_has_come_to_need) {
    const std::vector<std::pair<std::string, std::function<void(TableRun&)>>> changes{
        {"none", [](TableRun&) {}},
        {"large", [](TableRun& run) { run.add(bodies_of("pile:boxes=1100")); }},
        {"watched", [](TableRun& run) { run.simulation.watch_contacts(ContactWatch::Changes); }},
        {"bouncing", [](TableRun& run) { run.add(with_restitution(bodies_of("stack:height=2"), 0.5f)); }},
        {"with a platform", [](TableRun& run) { run.add(with_a_platform({})); }},
    };
    for (const auto& [name, change] : changes) {
        SCOPED_TRACE(name);
        SlowRun run(GetParam());
        run.add(bodies_of("stack:height=3"));
        run.step();
        change(run);
        run.step();
        run.gpu->ready = true;
        run.step();
        run.step();
        EXPECT_EQ(run.made_by(), kind_of(GetParam()));
        for (const std::string& kernel : run.gpu->ran)
            EXPECT_TRUE(run.gpu->given.contains(kernel)) << kernel;
    }
}

TEST_P(FirstSteps, are_saved_and_changed_as_others_are) {
    SlowRun slow(GetParam());
    PlainRun plain;
    for (TableRun* run : std::array<TableRun*, 2>{&slow, &plain}) {
        run->add(bodies_of("pool:boxes=20"));
        for (int i = 0; i < 30; ++i)
            run->step();
        run->add(bodies_of("stack:height=2")); // on their way to the device with the next step
        run->step();
        run->table.loads[5].force = {0.0f, 40.0f, 10.0f}; // for the step behind the change of device
        run->table.mark(5, engine::k_dirty_load);
        run->simulation.reserve_loads();
        run->simulation.change_bodies(
            run->table.population(),
            run->table.take_changes(run->simulation.has_room_for_loads())); // as before drawing
    }
    const engine::SavedState saved = slow.save();
    EXPECT_EQ(saved.report.device, DeviceKind::Cpu);
    slow.gpu->ready = true;
    for (int i = 0; i < 3; ++i) {
        slow.step();
        plain.step();
        ASSERT_TRUE(slow.motion() == plain.motion()) << "step " << i;
    }
    const std::vector<float> later = plain.motion();
    for (const DeviceKind kind : {GetParam(), DeviceKind::Cpu}) {
        SlowRun other(kind);
        other.gpu->ready = true;
        other.restore(saved);
        for (int i = 0; i < 3; ++i)
            other.step();
        EXPECT_TRUE(other.motion() == later);
    }
}

TEST_P(FirstSteps, can_be_drawn_from_the_gpus_buffers) {
    SlowRun slow(GetParam());
    slow.add(bodies_of("pool:boxes=20"));
    for (int i = 0; i < 40; ++i)
        slow.step();
    const uint pairs = slow.simulation.report().pairs;
    ASSERT_GT(pairs, 20u);
    slow.simulation.show_on_gpu();
    slow.simulation.show_on_gpu(); // as for the next picture
    Device& cpu = slow.simulation.state_device();
    ASSERT_NE(&cpu, slow.gpu);
    const std::vector<std::pair<BufferId, std::size_t>> drawn{
        {BufferId::Poses, slow.table.slot_count()},
        {BufferId::Starts, slow.table.slot_count()},
        {BufferId::Shapes, slow.table.slot_count()},
        {BufferId::Aabbs, slow.table.slot_count()},
        {BufferId::Pairs, pairs},
        {BufferId::OldManifolds, pairs},
        {BufferId::OldManifoldPoints, 4 * pairs},
        {BufferId::OldPointSeparations, pairs},
        {BufferId::OldPointImpulses, pairs},
        {BufferId::Counters, engine::k_counter_words},
    };
    for (const auto& [buffer, count] : drawn) {
        const auto& info = engine::k_buffers[static_cast<std::size_t>(buffer)];
        std::vector<std::byte> shown(count * info.stride), there = shown;
        slow.gpu->read(std::array{ReadRequest{buffer, shown.size(), shown.data()}});
        cpu.read(std::array{ReadRequest{buffer, there.size(), there.data()}});
        EXPECT_TRUE(shown == there) << info.block;
    }
    slow.step();
    EXPECT_EQ(slow.made_by(), DeviceKind::Cpu) << "to draw is not to wait";
}

TEST_P(FirstSteps, leave_the_newest_poses_until_there_are_newer_ones) {
    SlowRun run(GetParam());
    run.add(bodies_of("stack:height=3"));
    run.step(true);
    run.step(true);
    const std::vector<float> poses = run.motion();
    run.gpu->ready = true;
    const engine::Population population = run.table.population();
    run.simulation.step(population, false, {});
    run.simulation.settle();
    EXPECT_TRUE(run.simulation.newest_poses().empty()) << "of a step that was not asked for them";
    run.step(true);
    EXPECT_EQ(run.simulation.newest_poses().size(), run.table.slot_count());
}

TEST_P(FirstSteps, wait_where_the_cpu_would_take_too_long) {
    // Far apart, and weightless.
    std::vector<BodyDefinition> bodies(66'000);
    for (std::size_t i = 0; i < bodies.size(); ++i)
        bodies[i].pose.position = {3.0f * static_cast<float>(i % 300), 0.0f, 3.0f * static_cast<float>(i / 300)};
    Settings weightless;
    weightless.gravity = {};
    SlowRun slow(GetParam(), weightless, 1);
    slow.add(bodies);
    slow.step();
    EXPECT_EQ(slow.made_by(), kind_of(GetParam()));

    SlowRun growing(GetParam(), weightless, 1);
    growing.add({bodies.begin(), bodies.begin() + 100});
    growing.step();
    EXPECT_EQ(growing.made_by(), DeviceKind::Cpu);
    growing.add({bodies.begin() + 100, bodies.end()});
    growing.step();
    EXPECT_EQ(growing.made_by(), kind_of(GetParam()));
    EXPECT_EQ(growing.motion().size(), 16 * bodies.size());
}

TEST_P(FirstSteps, end_with_an_error_where_a_kernel_is_faulty) {
    SlowRun slow(GetParam());
    PlainRun plain;
    for (TableRun* run : std::array<TableRun*, 2>{&slow, &plain}) {
        run->add(bodies_of("stack:height=3"));
        run->step();
    }
    const std::vector<float> before = slow.motion();
    for (TableRun* run : std::array<TableRun*, 2>{&slow, &plain})
        run->add(bodies_of("stack:height=2"));
    slow.gpu->fault = "kernel so-and-so does not compile";
    for (int i = 0; i < 2; ++i) {
        try {
            slow.step();
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_STREQ(error.what(), slow.gpu->fault.c_str());
        }
    }
    EXPECT_EQ(slow.simulation.step_count(), 1u);
    EXPECT_TRUE(std::equal(before.begin(), before.begin() + 8, slow.motion().begin()));
    slow.gpu->fault.clear();
    slow.gpu->ready = true;
    slow.step(); // the bodies that came before the error are there
    plain.step();
    EXPECT_TRUE(slow.motion() == plain.motion());
}

TEST_P(FirstSteps, end_when_kernels_have_been_made_ready) {
    if (GetParam() != DeviceKind::Gpu) return; // elsewhere a kernel is a function of the library
    const std::unique_ptr<Device> device = engine::make_gl_device(GlContext::Own, false, false, false);
    const std::array needed{&engine::prepare_contacts, &engine::integrate_bodies};
    device->prepare(needed);
    int calls = 1; // each makes one ready at most, where one is compiled
    while (!device->make_ready(needed, std::chrono::milliseconds(0)))
        ++calls;
    EXPECT_GE(calls, 2);
    for (const engine::Kernel* kernel : needed)
        EXPECT_TRUE(device->is_ready(*kernel));
    EXPECT_EQ(device->launch_count(), 0u) << "of what does nothing";
    EXPECT_TRUE(device->make_ready(std::array{&engine::find_islands}, std::chrono::hours(1))) << "begun by itself";
}

INSTANTIATE_TEST_SUITE_P(Devices, FirstSteps, testing::Values(DeviceKind::Cpu, DeviceKind::Gpu, DeviceKind::Hybrid),
                         [](const auto& test) { return name_of(test.param); });

} // namespace
} // namespace talus::tests
