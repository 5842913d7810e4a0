// SPDX-License-Identifier: MIT
// Kernels that a driver is still compiling: until they are ready a step takes launches for each colour and pass
// instead, and nobody sees it by the bits.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "resolution/resolution.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"
#include "tests/stand_in_device.h"

namespace talus::tests {
namespace {

namespace fs = std::filesystem;
using engine::BufferId;
using engine::Device;
using engine::Kernel;
using engine::Launch;
using engine::Ticket;
using engine::uint;

constexpr std::array k_solvers{&engine::solve_islands,        &engine::solve_bouncing_islands,
                               &engine::solve_island_groups,  &engine::solve_bouncing_groups,
                               &engine::solve_single_islands, &engine::solve_bouncing_singles,
                               &engine::solve_persistent,     &engine::solve_multirate};

/// Another device, of which a test says which solvers are ready. It notes those that it is asked for and that it runs.
class LateDevice final : public StandInDevice {
public:
    using StandInDevice::StandInDevice;

    std::set<const Kernel*> late;
    std::set<const Kernel*> asked;
    std::set<const Kernel*> prepared;
    std::set<const Kernel*> ran;

    void prepare(std::span<const Kernel* const> kernels) override {
        prepared.insert(kernels.begin(), kernels.end());
        device->prepare(kernels);
    }

    bool make_ready(std::span<const Kernel* const> kernels, std::chrono::milliseconds) override {
        return device->make_ready(kernels, std::chrono::hours(1));
    }

    bool is_ready(const Kernel& kernel) override {
        asked.insert(&kernel);
        if (late.contains(&kernel)) return false;
        while (!device->is_ready(kernel)) // it is the test that says when
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return true;
    }

    void run(const Launch& launch) override {
        EXPECT_FALSE(late.contains(&launch.kernel)) << launch.kernel.path << " is not ready";
        if (is_solver(launch.kernel)) ran.insert(&launch.kernel);
        StandInDevice::run(launch);
    }

    /// Also on the CPU, which runs one group after the other.
    uint resident_groups(const Kernel& kernel) override {
        EXPECT_FALSE(late.contains(&kernel)) << kernel.path << " is not ready";
        const uint groups = device->resident_groups(kernel);
        return groups == 0 && is_solver(kernel) ? 64 : groups;
    }

private:
    static bool is_solver(const Kernel& kernel) {
        return std::ranges::any_of(k_solvers, [&](const Kernel* solver) { return solver == &kernel; });
    }
};

/// Three islands of 465 boxes, each too large to share a work group.
std::vector<BodyDefinition> three_pyramids() {
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < 3; ++i) {
        for (BodyDefinition& body : bodies_of("pyramid:base=30")) {
            body.pose.position.z += 1000.0f * static_cast<float>(i);
            bodies.push_back(body);
        }
    }
    return bodies;
}

struct LateRun {
    LateRun(DeviceKind kind, const std::vector<BodyDefinition>& bodies, bool waits) {
        WorldOptions options = options_on(kind);
        options.wait_for_kernels = waits;
        engine::Devices devices = engine::make_devices(options);
        auto late = std::make_unique<LateDevice>(std::move(kind == DeviceKind::Gpu ? devices.gpu : devices.cpu));
        device = late.get();
        devices.gpu = std::move(late); // whose kernels are prepared, whatever it is
        run = std::make_unique<EngineRun>(options, std::move(devices), bodies);
    }

    bool awaits_kernels() const { return run->simulation.plan_step(run->table.population()).awaits_kernels; }

    std::unique_ptr<EngineRun> run;
    LateDevice* device = nullptr; // the run's
};

class LateKernels : public OnDevice {};

TEST_P(LateKernels, are_replaced_by_launches_with_the_same_bits) {
    const std::vector<std::vector<BodyDefinition>> worlds{bodies_of("pool:boxes=20"),
                                                          with_restitution(bodies_of("pool:boxes=20"), 0.4f),
                                                          bodies_of("columns:side=20,height=3"),
                                                          bodies_of("pile:boxes=1100"),
                                                          with_restitution(bodies_of("pile:boxes=1100"), 0.4f),
                                                          three_pyramids()};
    std::minstd_rand random(1);
    for (std::size_t w = 0; w < worlds.size(); ++w) {
        SCOPED_TRACE(w);
        LateRun late(GetParam(), worlds[w], false), whole(GetParam(), worlds[w], true);
        late.device->late.insert(k_solvers.begin(), k_solvers.end());
        // A renderer in software has no use for them.
        EXPECT_EQ(late.awaits_kernels(), late.device->loops_freely());
        for (int i = 0; i < 16; ++i) {
            if (i == 12) late.device->late.clear();
            for (const Kernel* solver : k_solvers)
                if (i > 2 && i < 12 && random() % 4 == 0 && late.device->late.erase(solver) == 0)
                    late.device->late.insert(solver);
            if (i == 13) late.device->ran.clear(), whole.device->ran.clear();
            late.run->step();
            whole.run->step();
            ASSERT_TRUE(late.run->motion() == whole.run->motion()) << "step " << i;
        }
        EXPECT_FALSE(late.awaits_kernels());
        EXPECT_TRUE(std::ranges::includes(late.device->ran, whole.device->ran)) << "once all are ready";
        EXPECT_EQ(whole.device->ran.empty(), !whole.device->loops_freely());
    }
}

TEST_P(LateKernels, are_those_that_the_world_has_a_use_for) {
    LateRun small(GetParam(), bodies_of("pool:boxes=20"), false);
    if (!small.device->loops_freely()) return; // it has no use for any
    small.device->late.insert(k_solvers.begin(), k_solvers.end());
    small.run->step();
    EXPECT_EQ(small.device->asked, std::set<const Kernel*>{&engine::solve_islands});
    LateRun large(GetParam(), three_pyramids(), false);
    large.device->late.insert(k_solvers.begin(), k_solvers.end());
    large.run->step();
    EXPECT_EQ(large.device->asked, (std::set<const Kernel*>{&engine::solve_island_groups, &engine::solve_single_islands,
                                                            &engine::solve_persistent}));
}

TEST_P(LateKernels, solve_a_large_island_of_a_small_world_once_they_are_there) {
    LateRun late(GetParam(), bodies_of("wall"), false), plain(GetParam(), bodies_of("wall"), true);
    if (!late.device->loops_freely()) return; // it has no use for any
    late.device->late = {&engine::solve_persistent};
    for (int i = 0; i < 6; ++i) {
        if (i == 4) late.device->late.clear();
        late.device->ran.clear();
        late.run->step();
        plain.run->step();
        const Kernel* const solver = i < 4 ? &engine::solve_islands : &engine::solve_persistent;
        EXPECT_EQ(late.device->ran, std::set<const Kernel*>{solver}) << "step " << i;
        EXPECT_FALSE(late.awaits_kernels()) << "a work group does it, too";
        ASSERT_TRUE(late.run->motion() == plain.run->motion()) << "step " << i;
    }
    EXPECT_TRUE(plain.device->ran.contains(&engine::solve_persistent));
    LateRun small(GetParam(), bodies_of("pool:boxes=300"), true);
    for (int i = 0; i < 100; ++i)
        small.run->step();
    EXPECT_EQ(small.device->ran, std::set<const Kernel*>{&engine::solve_islands});
}

TEST_P(LateKernels, are_begun_with_the_others_where_a_small_world_may_have_a_large_island) {
    const auto begins_it = [&](const std::vector<BodyDefinition>& bodies) {
        LateRun run(GetParam(), bodies, false);
        run.run->step();
        return run.device->prepared.contains(&engine::solve_persistent);
    };
    EXPECT_EQ(begins_it(bodies_of("wall")), LateRun(GetParam(), {}, true).device->loops_freely());
    EXPECT_FALSE(begins_it(bodies_of("pool:boxes=20")));
    EXPECT_FALSE(begins_it(with_restitution(bodies_of("wall"), 0.5f))) << "what bounces is solved by other kernels";
}

TEST_P(LateKernels, leave_a_small_world_to_groups_where_its_island_is_large_no_more) {
    LateRun run(GetParam(), bodies_of("wall"), true);
    if (!run.device->loops_freely()) return;
    run.run->step();
    run.run->step();
    EXPECT_TRUE(run.device->ran.contains(&engine::solve_persistent));
    // Gone, or far apart: bodies that nothing touches.
    std::vector<engine::BodyPose>& poses = run.run->table.poses;
    for (std::size_t i = 300; i < poses.size(); ++i)
        poses[i].position.y += 100.0f * static_cast<float>(i);
    run.run->simulation.write(BufferId::Poses, 0, std::span<const engine::BodyPose>(poses));
    run.run->simulation.search_anew();
    run.run->step(130);
    run.device->ran.clear();
    run.run->step();
    EXPECT_EQ(run.device->ran, std::set<const Kernel*>{&engine::solve_islands});
}

TEST_P(LateKernels, are_told_how_large_islands_are) {
    std::vector<BodyDefinition> bodies = bodies_of("grid:stacks=3");
    bodies.push_back(box_at({0.0f, 50.0f, 0.0f})); // touches nothing
    LateRun stacks(GetParam(), bodies, true);
    for (int i = 0; i < 12; ++i) {
        stacks.run->step();
        EXPECT_EQ(stacks.run->counter(engine::k_counter_largest_island), 5u) << "step " << i;
    }
}

TEST_P(LateKernels, are_not_asked_for_where_the_caller_waits) {
    LateRun waiting(GetParam(), bodies_of("pool:boxes=20"), true);
    waiting.run->step();
    EXPECT_FALSE(waiting.awaits_kernels());
    EXPECT_TRUE(waiting.device->asked.empty());
}

TEST_P(LateKernels, that_are_faulty_are_told_of_once) {
    if (GetParam() != DeviceKind::Gpu) return; // there a kernel is a function of the library
    const fs::path folder = fs::path(testing::TempDir()) / ("talus_faulty_kernel_" + std::to_string(getpid()));
    fs::create_directories(folder / "resolution");
    std::ofstream(folder / "resolution/solve_islands.comp.glsl") << "void main() { faulty }\n";
    setenv("TALUS_KERNEL_PATH", folder.c_str(), 1);
    std::vector<std::string> warnings;
    set_log_hook([&](LogLevel level, std::string_view message) {
        if (level == LogLevel::Warning) warnings.emplace_back(message);
    });
    const std::unique_ptr<Device> device = engine::make_gl_device(GlContext::Own, false, false, false);
    for (int i = 0; i < 1000 && warnings.empty(); ++i) {
        EXPECT_FALSE(device->is_ready(engine::solve_islands));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_FALSE(device->is_ready(engine::solve_islands));
    set_log_hook({});
    unsetenv("TALUS_KERNEL_PATH");
    fs::remove_all(folder);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("resolution/solve_islands does not"), std::string::npos) << warnings[0];
}

INSTANTIATE_TEST_SUITE_P(Devices, LateKernels, testing::Values(DeviceKind::Cpu, DeviceKind::Gpu),
                         [](const auto& test) { return name_of(test.param); });

} // namespace
} // namespace talus::tests
