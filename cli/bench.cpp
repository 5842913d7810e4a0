// SPDX-License-Identifier: MIT
// talus bench: how long a step takes, and how good it is, scene by scene and device by device.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/bench_cases.h"
#include "bench/bench_options.h"
#include "bench/bench_table.h"
#include "bench/broad_phases.h"
#include "bench/comparison.h"
#include "bench/measurement.h"
#include "bench/peer.h"
#include "bench/row_lines.h"
#include "bench/size_curves.h"
#include "bench/solver_curves.h"
#include "cli/commands.h"

namespace talus::cli {
namespace {

using bench::BenchOptions;
using Json = nlohmann::ordered_json;

/// The rounds of one case, by engine.
struct Rounds {
    std::vector<bench::Row> talus, peer;
    std::vector<double> ratios; ///< Talus's median time over the peer's, round by round
};

Rounds measure_rounds(const bench::Case& bench_case, const BenchOptions& options) {
    Rounds rounds;
    for (std::uint32_t round = 0; round < options.repeats; ++round) {
        bench::Measurement measured = bench::measure(bench_case, options);
        if (measured.peer) {
            rounds.ratios.push_back(measured.talus.median_ms() / measured.peer->median_ms());
            rounds.peer.push_back(std::move(*measured.peer));
        }
        rounds.talus.push_back(std::move(measured.talus));
    }
    return rounds;
}

/// What no run of Talus may do, whatever its speed. Returns the exit status.
int check_rounds(const std::vector<bench::Row>& rounds) {
    int status = k_done;
    const RunReport& first = rounds.front().report;
    const auto complain = [&](const std::string& fault) {
        fmt::print(stderr, "talus: {} on {}: {}\n", first.scene, rounds.front().runs_on, fault);
        status = k_failed_own_check;
    };
    if (first.nonfinite_bodies() > 0)
        complain(fmt::format("{} of {} bodies became non-finite and were frozen", first.nonfinite_bodies(),
                             first.bodies.total));
    if (std::ranges::any_of(rounds, [&](const bench::Row& row) { return row.report.state_hash != first.state_hash; }))
        complain("repeated runs ended in different states");
    return status;
}

int run_benchmark(BenchOptions options) {
    const bool has_peer = !options.peer.empty();
    if (has_peer) bench::require_bullet();
    // The peer has one thread, so for want of another wish Talus has one too.
    if (has_peer && options.simulation.threads == 0) options.simulation.threads = 1;
    std::vector<Json> earlier;
    if (!options.against.empty()) earlier = bench::read_row_lines(options.against);
    const std::vector<DeviceInfo> devices = bench::find_devices(options);
    const std::vector<bench::Case> cases = bench::make_cases(options, devices);

    std::FILE* const out = options.json ? stderr : stdout;
    const bench::BenchTable table(out, cases, options);
    table.print_devices(devices);
    table.print_header();
    int status = k_done;
    std::vector<Json> now;
    for (const bench::Case& bench_case : cases) {
        const Rounds rounds = measure_rounds(bench_case, options);
        table.print(rounds.talus, rounds.ratios);
        if (has_peer) table.print(rounds.peer);
        for (const std::vector<bench::Row>* rows : {&rounds.talus, &rounds.peer})
            for (const bench::Row& row : *rows) {
                now.push_back(bench::to_json(row));
                if (options.json) fmt::print("{}\n", now.back().dump());
            }
        std::fflush(stdout);
        status = std::max(status, check_rounds(rounds.talus));
    }
    if (!options.against.empty()) fmt::print(out, "\n{}", bench::compare_rows(earlier, now));
    return status;
}

/// An experiment that writes a file. Returns the exit status.
int run_experiment(std::uint64_t (*measure)(const BenchOptions&, std::FILE*), const BenchOptions& options,
                   const std::filesystem::path& file) {
    const std::uint64_t nonfinite = measure(options, stdout);
    fmt::print("wrote {}\n", file.string());
    if (nonfinite == 0) return k_done;
    fmt::print(stderr, "talus: {} bodies became non-finite and were frozen, in all runs together\n", nonfinite);
    return k_failed_own_check;
}

int run_bench(const BenchOptions& options) {
    if (!options.solver_curves.empty())
        return run_experiment(bench::measure_solver_curves, options, options.solver_curves);
    if (!options.broad_phases.empty())
        return run_experiment(bench::measure_broad_phases, options, options.broad_phases);
    if (!options.size_curves.empty()) return run_experiment(bench::measure_size_curves, options, options.size_curves);
    return run_benchmark(options);
}

} // namespace

void add_bench(CLI::App& app, int& status) {
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = app.add_subcommand("bench", "Measure time and quality (docs/benchmark.md)");
    bench::add_bench_options(*command, *options);
    command->callback([options, &status] { status = run_bench(*options); });
}

} // namespace talus::cli
