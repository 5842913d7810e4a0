// SPDX-License-Identifier: MIT
// The times stand in the last column of the file, so that the rest is the same from run to run.
#include "bench/solver_curves.h"

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

constexpr std::array k_scenes{"stack:height=10", "pool:boxes=200", "extreme_stack"};
// The thesis goes up to 150 iterations.
constexpr std::array<std::uint32_t, 13> k_iterations{1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 75, 100, 150};
constexpr std::array<std::uint32_t, 7> k_substeps{1, 2, 4, 8, 16, 32, 64};

constexpr std::string_view k_columns = "scene,stabilisation,solve_order,passes,steps,max_drift_m,max_drift_sideways_m,"
                                       "max_penetration_m,kinetic_energy_j_a_body,"
                                       "escaped_bodies,nonfinite_bodies,median_ms\n";

std::string csv_row(const cli::RunReport& report, std::uint32_t passes, double median_ms) {
    const cli::Quality& quality = report.quality;
    const double bodies = static_cast<double>(std::max<std::uint64_t>(report.bodies.dynamic, 1));
    return fmt::format("\"{}\",{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{:.6g}\n", report.scene,
                       cli::word_of(cli::stabilisation_words(), report.settings.stabilisation),
                       cli::word_of(cli::solve_order_words(), report.settings.solve_order), passes, report.timing.steps,
                       quality.max_drift, quality.max_drift_sideways, quality.max_penetration,
                       quality.kinetic_energy / bodies, quality.escaped_bodies, report.nonfinite_bodies(), median_ms);
}

} // namespace

std::uint64_t measure_solver_curves(const BenchOptions& given, std::FILE* out) {
    cli::check_output(given.solver_curves);
    BenchOptions options = given;
    if (options.scenes.empty()) options.scenes.assign(k_scenes.begin(), k_scenes.end());
    const std::vector<DeviceInfo> devices = find_devices(options);
    if (devices.size() != 1) throw Error("--solver-curves: measures one device; --devices names several");

    std::string csv(k_columns);
    std::uint64_t nonfinite = 0;
    fmt::print(out, "{:<16} {:<10} {:<10} {:>6} {:>10} {:>10} {:>10}\n", "scene", "scheme", "order", "passes",
               "median ms", "drift", "overlap");
    const auto measure_point = [&](const Case& bench_case, Stabilisation stabilisation, std::uint32_t passes) {
        cli::SimulationOptions& simulation = options.simulation;
        simulation.stabilisation = stabilisation;
        const bool soft = stabilisation == Stabilisation::Soft;
        simulation.substeps.reset();
        simulation.iterations.reset();
        (soft ? simulation.substeps : simulation.iterations) = passes;
        const Row row = measure(bench_case, options).talus;
        nonfinite += row.report.nonfinite_bodies();
        csv += csv_row(row.report, passes, row.median_ms());
        fmt::print(out, "{:<16} {:<10} {:<10} {:>6} {:>10.4f} {:>10} {:>10}\n", bench_case.scene,
                   cli::word_of(cli::stabilisation_words(), stabilisation),
                   cli::word_of(cli::solve_order_words(), *simulation.solve_order), passes, row.median_ms(),
                   cli::length_text(row.report.quality.max_drift),
                   cli::length_text(row.report.quality.max_penetration));
        std::fflush(out);
    };
    for (const Case& bench_case : make_cases(options, devices)) {
        for (const SolveOrder order : {SolveOrder::Coloured, SolveOrder::Sequential}) {
            options.simulation.solve_order = order;
            for (const std::uint32_t iterations : k_iterations)
                measure_point(bench_case, Stabilisation::Baumgarte, iterations);
            for (const std::uint32_t substeps : k_substeps)
                measure_point(bench_case, Stabilisation::Soft, substeps);
        }
    }
    cli::write_output(options.solver_curves, csv);
    return nonfinite;
}

} // namespace talus::bench
