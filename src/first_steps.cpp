// SPDX-License-Identifier: MIT
// Where steps are made. The CPU makes the first ones of a world on a GPU, with the same bits, while the GPU's driver
// compiles the kernels that no step can do without.
#include <algorithm>

#include "device/cpu/cpu_threads.h"
#include "device/kernel_list.h"
#include "hand_over.h"
#include "log.h"
#include "narrow_phase/narrow_phase.h"
#include "primitives/primitives.h"
#include "resolution/resolution.h"
#include "simulation.h"

#include <fmt/format.h>

namespace talus::engine {
namespace {

// How long a first step waits for kernels: enough where the driver has them from an earlier start.
constexpr std::chrono::milliseconds k_patience_with_kernels{150};
// With more bodies for each thread of the CPU, to wait for the driver is likely to be quicker.
constexpr std::uint64_t k_most_bodies_a_thread = 65'536;

/// In a small world, one that a work group would take long for.
bool may_have_large_island(const StepPlan& plan) {
    constexpr uint k_fewest_bodies = 256;
    return plan.small && plan.in_groups && plan.body_count >= k_fewest_bodies;
}

} // namespace

Placement Simulation::placement_with_kernels() const {
    Device* const detection = gpu ? gpu.get() : cpu.get();
    return {detection, info.kind == DeviceKind::Hybrid ? cpu.get() : detection};
}

void Simulation::begin_kernels(const Population& population) {
    const Placement last = placement_with_kernels();
    StepPlan quickest = plan_in_launches(population, IslandSolve::Groups);
    // How many groups it will have is found by a trial of the kernel itself.
    const auto groups_of = [&](const StepPlan& by) { return by.may_be_persistent() && gpu->loops_freely() ? 1u : 0u; };
    quickest.persistent_groups = groups_of(quickest);
    // What a large world may need at any time.
    quickest.singles = quickest.has_groups();
    StepPlan first = waits_for_kernels ? quickest : plan_in_launches(population, IslandSolve::Launches);
    KernelList list(*placement.detection); // which has the plan's room
    const auto note = [&](Stage stage, const StepPlan& by) {
        if (&last.of(stage) == gpu.get()) run_stage(list, stage, by);
    };
    // What the first step waits for comes first, and of that what a driver compiles longest.
    note(Stage::NarrowPhase, first);
    note(Stage::Solve, first);
    for (const Stage stage : k_stages)
        note(stage, first);
    first.search = Search::None;
    note(Stage::BroadPhase, first);
    if (!first.small && !last.hybrid()) list.run({.kernel = weigh_hubs});
    scatter_changed_records(list, BufferId::Poses, 1);
    forget_changed_turns(list, 1);
    needed_kernels = list.kernels;
    note(Stage::Solve, quickest);
    if (may_have_large_island(quickest)) {
        quickest.in_groups = false;
        quickest.persistent_groups = groups_of(quickest);
        if (quickest.persistent_groups > 0) note(Stage::Solve, quickest);
    }
    if (waits_for_kernels) needed_kernels = list.kernels;
    gpu->prepare(list.kernels);
}

void Simulation::choose_placement(const Population& population) {
    const bool is_first = !kernels_begun;
    if (!gpu || (!is_first && !waits_on_cpu())) return;
    kernels_begun = true;
    begin_kernels(population); // anew, as the caller may have changed what a step needs
    if (is_first && info.in_software) return;
    if (is_first && waits_for_kernels) {
        gpu->make_ready(needed_kernels, std::chrono::hours(1));
        return;
    }
    if (!may_be_on_cpu(population)) {
        if (waits_on_cpu()) move_to_gpu();
        return;
    }
    // Where the CPU's steps are quick the caller is kept for one kernel, and else for as long again as a step takes.
    using std::chrono::milliseconds;
    const milliseconds patience =
        is_first ? k_patience_with_kernels : std::chrono::duration_cast<milliseconds>(newest_time);
    const bool ready = gpu->make_ready(needed_kernels, patience);
    if (is_first && !ready) begin_on_cpu();
    if (waits_on_cpu() && ready) move_to_gpu();
}

bool Simulation::may_be_on_cpu(const Population& population) const {
    return population.slots <= k_most_bodies_a_thread * threads_asked_for(cpu_threads);
}

void Simulation::begin_on_cpu() {
    if (!cpu) {
        std::unique_ptr<Device> host = make_cpu_device(cpu_threads, profiles);
        try {
            for (std::size_t i = 0; i < k_buffers.size(); ++i) {
                const BufferId buffer = static_cast<BufferId>(i);
                const bool shares_a_place = std::ranges::find(k_by_turns, buffer) != k_by_turns.end();
                const bool is_of_gpu = buffer == BufferId::FastBodies; // no twin has a use for it
                if (!shares_a_place && !is_of_gpu) host->grow(buffer, gpu->size(buffer));
            }
            host->grow(BufferId::Uncoloured, plan.pair_capacity * sizeof(uint));
        } catch (const Error& error) {
            log(LogLevel::Info, std::string("a step waits for the GPU's kernels: ") + error.what());
            return;
        }
        hand_over_state(*gpu, *host, {enqueued_slots, newest_report.pairs});
        cpu = std::move(host);
    }
    log(LogLevel::Info, "the GPU's kernels are still being compiled: until then the CPU makes the steps");
    placement = {cpu.get(), cpu.get()};
}

void Simulation::show_on_gpu() {
    if (waits_on_cpu()) {
        hand_over_drawn(*cpu, *gpu, {enqueued_slots, newest_report.pairs});
    } else if (placement.hybrid()) {
        hand_over_places(*cpu, *gpu, enqueued_slots);
    }
}

void Simulation::move_to_gpu() {
    settle();
    hand_over_state(*cpu, *gpu, {enqueued_slots, newest_report.pairs});
    kept_count = 0; // constraints stay, as the next step makes them anew
    placement = placement_with_kernels();
    plan.most_launched = k_none;
    pairs_last.begin_anew();
    list_lasts.begin_anew();
    begin_graph_anew();
    log(LogLevel::Info, fmt::format("the GPU makes the steps from number {} on", finished_count + 1));
}

} // namespace talus::engine
