// SPDX-License-Identifier: MIT
// Kernels that a driver is still compiling: until they are ready a step takes launches for each colour and pass
// instead, and nobody sees it by the bits.
#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "resolution/resolution.h"
#include "scenes/scene.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

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

/// Another device whose solvers that need no launch for each colour are not ready until it is told so.
class LateDevice final : public Device {
public:
    explicit LateDevice(std::unique_ptr<Device> replaced) : device(std::move(replaced)) {}

    bool has_solvers = false;
    bool was_asked = false;  ///< for a solver that is not ready
    bool has_solved = false; ///< by one

    bool is_ready(const Kernel& kernel) override {
        const bool is_late = is_solver(kernel) && !has_solvers;
        was_asked = was_asked || is_late;
        return !is_late && device->is_ready(kernel);
    }

    void run(const Launch& launch) override {
        EXPECT_TRUE(has_solvers || !is_solver(launch.kernel)) << launch.kernel.path << " is not ready";
        has_solved = has_solved || is_solver(launch.kernel);
        device->run(launch);
        launches = device->launch_count();
    }

    uint resident_groups(const Kernel& kernel) override {
        EXPECT_TRUE(has_solvers || !is_solver(kernel)) << kernel.path << " is not ready";
        return device->resident_groups(kernel);
    }

    DeviceInfo info() const override { return device->info(); }
    bool loops_freely() const override { return device->loops_freely(); }
    void grow(BufferId buffer, std::size_t bytes) override { device->grow(buffer, bytes); }
    std::size_t size(BufferId buffer) const override { return device->size(buffer); }
    std::uint64_t memory_bytes() const override { return device->memory_bytes(); }
    void write(BufferId buffer, std::size_t offset, std::span<const std::byte> bytes) override {
        device->write(buffer, offset, bytes);
    }
    void read(std::span<const engine::ReadRequest> requests) override { device->read(requests); }
    void swap(BufferId a, BufferId b) override { device->swap(a, b); }
    void set_parameters(const engine::Parameters& parameters) override { device->set_parameters(parameters); }
    void prepare(std::span<const Kernel* const> kernels) override { device->prepare(kernels); }
    void begin_stage(engine::Stage stage) override { device->begin_stage(stage); }
    Ticket end_step(bool with_poses, uint report_room) override { return device->end_step(with_poses, report_room); }
    bool finished(Ticket ticket) const override { return device->finished(ticket); }
    void wait(Ticket ticket) override { device->wait(ticket); }
    std::span<const uint> counters(Ticket ticket) const override { return device->counters(ticket); }
    std::span<const engine::BodyPose> poses(Ticket ticket) const override { return device->poses(ticket); }
    std::span<const engine::ContactReport> reports(Ticket ticket) const override { return device->reports(ticket); }
    std::span<const double> stage_ms(Ticket ticket) const override { return device->stage_ms(ticket); }
    void leave() override { device->leave(); }
    std::byte* host_data(BufferId buffer) override { return device->host_data(buffer); }
    std::uint32_t gl_name(BufferId buffer) const override { return device->gl_name(buffer); }
    void make_current() override { device->make_current(); }

private:
    static bool is_solver(const Kernel& kernel) {
        return std::ranges::any_of(k_solvers, [&](const Kernel* solver) { return solver == &kernel; });
    }

    std::unique_ptr<Device> device;
};

std::vector<BodyDefinition> bodies_of(const char* scene, float restitution) {
    std::vector<BodyDefinition> bodies;
    for (const scenes::NamedBody& body : scenes::make_scene(scene).bodies) {
        bodies.push_back(body.definition);
        bodies.back().material.restitution = restitution;
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
    for (const auto& [scene, restitution] : {std::pair("pool:boxes=20", 0.0f), std::pair("pool:boxes=20", 0.4f),
                                             std::pair("columns:side=20,height=3", 0.0f),
                                             std::pair("pile:boxes=1100", 0.0f), std::pair("pile:boxes=1100", 0.4f)}) {
        SCOPED_TRACE(scene);
        const std::vector<BodyDefinition> bodies = bodies_of(scene, restitution);
        LateRun late(GetParam(), bodies, false);
        EngineRun whole(options_on(GetParam()), bodies);
        for (int i = 0; i < 12; ++i) {
            late.device->has_solvers = i >= 6;
            // A renderer in software makes no use of them.
            EXPECT_EQ(late.awaits_kernels(), i < 6 && late.device->loops_freely()) << i;
            late.run->step(2);
            whole.step(2);
            ASSERT_TRUE(late.run->motion() == whole.motion()) << "step " << 2 * i;
        }
        EXPECT_EQ(late.device->was_asked, late.device->loops_freely());
        EXPECT_EQ(late.device->has_solved, late.device->loops_freely());
    }
}

TEST_P(LateKernels, are_not_asked_for_where_the_caller_waits) {
    LateRun waiting(GetParam(), bodies_of("pool:boxes=20", 0.0f), true);
    EXPECT_FALSE(waiting.awaits_kernels());
    EXPECT_FALSE(waiting.device->was_asked);
}

INSTANTIATE_TEST_SUITE_P(Devices, LateKernels, testing::Values(DeviceKind::Cpu, DeviceKind::Gpu),
                         [](const auto& test) { return name_of(test.param); });

} // namespace
} // namespace talus::tests
