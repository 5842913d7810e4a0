// SPDX-License-Identifier: MIT
// Two families of scenes: what stands in one layer of small stacks, and what falls into a heap.
#include "bench/size_curves.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "bench/bench_cases.h"
#include "bench/measurement.h"
#include "cli/output_file.h"
#include "cli/summary.h"
#include "cli/words.h"

namespace talus::bench {
namespace {

struct Family {
    std::string_view name, parameter;
    std::uint32_t boxes, most; ///< for each unit of the parameter, and of it
};
constexpr std::array k_families{Family{"grid", "stacks", 5, 400'000}, Family{"pile", "boxes", 1, 1'000'000}};
constexpr std::array<std::uint32_t, 6> k_sizes{100, 300, 1'000, 3'000, 10'000, 30'000};

std::vector<Family> families_of(const BenchOptions& options) {
    if (options.scenes.empty()) return {k_families.begin(), k_families.end()};
    std::vector<Family> families;
    for (const std::string& given : options.scenes) {
        const auto* const found = std::ranges::find(k_families, given, &Family::name);
        if (found == k_families.end())
            throw Error(fmt::format("--size-curves: '{}' is not one of grid, pile; the number of boxes is that of "
                                    "--sizes",
                                    given));
        families.push_back(*found);
    }
    return families;
}

std::string columns() {
    std::string names = "family,scene,device,device_name,threads,boxes,steps,median_ms,mean_ms,p95_ms,device_bytes,"
                        "bytes_a_body,dispatches,pairs,contacts,substeps,growths,max_drift_m,max_penetration_m,"
                        "kinetic_energy_j_a_body,escaped_bodies,nonfinite_bodies";
    for (const char* stage : stage_names())
        names += fmt::format(",{}_ms", stage);
    return names + '\n';
}

std::string csv_row(std::string_view family, const Row& row) {
    const cli::RunReport& report = row.report;
    const cli::Statistics times = cli::statistics_of(report.timing.step_ms);
    const cli::Quality& quality = report.quality;
    const double boxes = static_cast<double>(std::max<std::uint64_t>(report.bodies.dynamic, 1));
    const double bytes_a_body = static_cast<double>(report.memory.device) / static_cast<double>(report.bodies.total);
    std::string text = fmt::format(
        "{},\"{}\",{},\"{}\",{},{},{},{:.6g},{:.6g},{:.6g},{},{:.6g},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{},{}", family,
        report.scene, row.runs_on, report.device.name, report.device.threads, report.bodies.dynamic,
        report.timing.steps, times.median, times.mean, times.p95, report.memory.device, bytes_a_body,
        report.last_step.dispatches, report.last_step.pairs, report.last_step.contacts, report.last_step.substeps,
        report.last_step.growths, quality.max_drift, quality.max_penetration, quality.kinetic_energy / boxes,
        quality.escaped_bodies, report.nonfinite_bodies());
    for (const double stage : report.timing.stage_ms)
        text += fmt::format(",{:.6g}", stage);
    return text + '\n';
}

} // namespace

std::uint64_t measure_size_curves(const BenchOptions& given, std::FILE* out) {
    cli::check_output(given.size_curves);
    BenchOptions options = given;
    options.stages = true;
    if (options.sizes.empty()) options.sizes.assign(k_sizes.begin(), k_sizes.end());
    const std::vector<Family> families = families_of(options);

    std::string csv = columns();
    std::uint64_t nonfinite = 0;
    fmt::print(out, "{:<20} {:<6} {:>8} {:>10} {:>10} {:>8} {:>10} {:>10} {:>10}\n", "scene", "device", "boxes",
               "median ms", "mean ms", "B/body", "dispatches", "drift", "overlap");
    for (const DeviceInfo& device : find_devices(options)) {
        for (const Family& family : families) {
            for (const std::uint32_t boxes : options.sizes) {
                const std::uint32_t size = std::max(1u, boxes / family.boxes);
                if (size > family.most) continue;
                const Case point{fmt::format("{}:{}={}", family.name, family.parameter, size), device.kind};
                const Row row = measure(point, options).talus;
                const cli::RunReport& report = row.report;
                nonfinite += report.nonfinite_bodies();
                csv += csv_row(family.name, row);
                const cli::Statistics times = cli::statistics_of(report.timing.step_ms);
                fmt::print(out, "{:<20} {:<6} {:>8} {:>10.4f} {:>10.4f} {:>8} {:>10} {:>10} {:>10}\n", point.scene,
                           row.runs_on, report.bodies.dynamic, times.median, times.mean,
                           report.memory.device / report.bodies.total, report.last_step.dispatches,
                           cli::length_text(report.quality.max_drift),
                           cli::length_text(report.quality.max_penetration));
                std::fflush(out);
            }
        }
    }
    cli::write_output(options.size_curves, csv);
    return nonfinite;
}

} // namespace talus::bench
