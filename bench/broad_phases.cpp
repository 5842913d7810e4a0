// SPDX-License-Identifier: MIT
// The times stand in the last columns of the file, so that the rest is the same from run to run.
#include "bench/broad_phases.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "bench/bench_cases.h"
#include "bench/measurement.h"
#include "cli/output_file.h"
#include "cli/words.h"

namespace talus::bench {
namespace {

constexpr std::array<std::uint32_t, 5> k_sizes{100, 1'000, 10'000, 100'000, 1'000'000};
constexpr std::uint32_t k_most_without_gpu = 10'000; // what a renderer in software steps in less than a second or two
// Every pair of more would be five billion tests and more a step.
constexpr std::uint64_t k_most_by_force = 100'100;

constexpr std::string_view k_columns = "scene,device,bodies,broad_phase,steps,pairs,broad_phase_ms,median_ms\n";

/// Fields of stacks, heaps, and sizes that differ, as large as suits the device.
std::vector<std::string> scene_list(const DeviceInfo& device) {
    const bool is_hardware = device.kind != DeviceKind::Cpu && !device.in_software;
    std::vector<std::string> scenes;
    for (const std::uint32_t size : k_sizes) {
        if (!is_hardware && size > k_most_without_gpu) continue;
        scenes.push_back(fmt::format("grid:stacks={}", size / 5));
        scenes.push_back(fmt::format("pile:boxes={}", size));
        scenes.push_back(fmt::format("rubble:boxes={}", size));
    }
    return scenes;
}

} // namespace

std::uint64_t measure_broad_phases(const BenchOptions& given, std::FILE* out) {
    cli::check_output(given.broad_phases);
    BenchOptions options = given;
    options.stages = true;
    options.searches_always = true;
    const std::vector<DeviceInfo> devices = find_devices(options);
    if (devices.size() != 1) throw Error("--broad-phases: measures one device; --devices names several");
    if (options.scenes.empty()) options.scenes = scene_list(devices.front());
    const std::vector<Case> cases = make_cases(options, devices);

    std::size_t width = 5;
    for (const Case& bench_case : cases)
        width = std::max(width, bench_case.scene.size());
    std::string csv(k_columns);
    std::uint64_t nonfinite = 0;
    fmt::print(out, "{:<{}}  {:<6} {:>8} {:<11} {:>9} {:>14} {:>10}\n", "scene", width, "device", "bodies",
               "broad phase", "pairs", "broad phase ms", "median ms");
    for (const Case& bench_case : cases) {
        std::uint64_t body_count = 0;
        for (const auto& [word, broad_phase] : cli::broad_phase_words()) {
            if (broad_phase == BroadPhase::Auto) continue;
            if (broad_phase == BroadPhase::Brute && body_count > k_most_by_force) continue; // the last in the list
            options.simulation.broad_phase = broad_phase;
            const Row row = measure(bench_case, options).talus;
            const cli::RunReport& report = row.report;
            body_count = report.bodies.total;
            nonfinite += report.nonfinite_bodies();
            const double broad_phase_ms = report.timing.stage_ms.front();
            fmt::print(out, "{:<{}}  {:<6} {:>8} {:<11} {:>9} {:>14.4f} {:>10.4f}\n", report.scene, width, row.runs_on,
                       body_count, word, report.last_step.pairs, broad_phase_ms, row.median_ms());
            std::fflush(out);
            csv += fmt::format("\"{}\",{},{},{},{},{},{:.6g},{:.6g}\n", report.scene, row.runs_on, body_count, word,
                               report.timing.steps, report.last_step.pairs, broad_phase_ms, row.median_ms());
        }
    }
    cli::write_output(options.broad_phases, csv);
    return nonfinite;
}

} // namespace talus::bench
