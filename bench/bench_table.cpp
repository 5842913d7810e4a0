// SPDX-License-Identifier: MIT
// Columns that were not asked for are left out. Quality is that of the last round: rounds of Talus end alike.
#include "bench/bench_table.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "cli/summary.h"
#include "cli/words.h"

namespace talus::bench {
namespace {

constexpr std::string_view k_none = "–";

/// 1234567 as 1.23 M.
std::string short_number(double number) {
    constexpr std::array k_units{"", " k", " M", " G"};
    std::size_t unit = 0;
    while (number >= 999.5 && unit + 1 < k_units.size()) {
        number /= 1000.0;
        ++unit;
    }
    return fmt::format("{:.3g}{}", number, k_units[unit]);
}

double per_body(double total, std::uint64_t bodies) {
    return bodies > 0 ? total / static_cast<double>(bodies) : 0.0;
}

/// How far apart the lowest and the highest are, in percent of the one in the middle.
double spread_of(const std::vector<double>& numbers) {
    const auto [low, high] = std::ranges::minmax(numbers);
    const double middle = median_of(numbers);
    return middle > 0.0 ? 100.0 * (high - low) / middle : 0.0;
}

template <typename Figure> std::vector<double> over_rounds(std::span<const Row> rounds, const Figure& figure) {
    std::vector<double> numbers;
    for (const Row& row : rounds)
        numbers.push_back(std::invoke(figure, row));
    return numbers;
}

} // namespace

double median_of(std::vector<double> numbers) {
    return cli::statistics_of(std::move(numbers)).median;
}

BenchTable::BenchTable(std::FILE* output, const std::vector<Case>& cases, const BenchOptions& options)
    : out(output), scene_width(5), spread(options.repeats > 1), ratio(!options.peer.empty()), stages(options.stages) {
    for (const Case& bench_case : cases)
        scene_width = std::max(scene_width, bench_case.scene.size());
}

void BenchTable::print_devices(const std::vector<DeviceInfo>& devices) const {
    for (const DeviceInfo& device : devices)
        fmt::print(out, "{}: {}{}, {}\n", cli::word_of(cli::device_words(), device.kind), device.name,
                   device.in_software ? " (in software)" : "", device.driver);
}

void BenchTable::print_header() const {
    fmt::print(out, "{:<{}}  {:<6} {:>7} {:>8} {:>10} {:>10}", "scene", scene_width, "device", "threads", "bodies",
               "median ms", "p95 ms");
    if (spread) fmt::print(out, " {:>7}", "spread");
    fmt::print(out, " {:>12} {:>8} {:>9} {:>9} {:>9} {:>7}", "body-steps/s", "B/body", "drift", "overlap", "J/body",
               "escaped");
    if (ratio) fmt::print(out, " {:>6}{}", "ratio", spread ? "  spread" : "");
    fmt::print(out, "\n");
    std::fflush(out);
}

void BenchTable::print(std::span<const Row> rounds, std::span<const double> ratios) const {
    const Row& last = rounds.back();
    const cli::RunReport& report = last.report;
    const cli::Quality& quality = report.quality;
    const std::uint64_t bodies = report.bodies.dynamic;
    const std::vector<double> medians = over_rounds(rounds, &Row::median_ms);
    const double p95 = median_of(
        over_rounds(rounds, [](const Row& row) { return cli::statistics_of(row.report.timing.step_ms).p95; }));
    const double steps_per_second =
        median_of(over_rounds(rounds, [](const Row& row) { return row.report.steps_per_second(); }));

    fmt::print(out, "{:<{}}  {:<6} {:>7} {:>8} {:>10.4f} {:>10.4f}", report.scene, scene_width, last.runs_on,
               report.device.threads > 0 ? fmt::to_string(report.device.threads) : k_none, bodies, median_of(medians),
               p95);
    if (spread) fmt::print(out, " {:>5.1f} %", spread_of(medians));
    const double bytes = per_body(static_cast<double>(report.memory.device), report.bodies.total);
    fmt::print(
        out, " {:>12} {:>8} {:>9} {:>9} {:>9.2g} {:>7}", short_number(static_cast<double>(bodies) * steps_per_second),
        last.is_peer ? std::string(k_none) : short_number(bytes), cli::length_text(quality.max_drift),
        cli::length_text(quality.max_penetration), per_body(quality.kinetic_energy, bodies), quality.escaped_bodies);
    if (!ratios.empty()) {
        const std::vector<double> numbers(ratios.begin(), ratios.end());
        fmt::print(out, " {:>6.3f}", median_of(numbers));
        if (spread) fmt::print(out, " {:>5.1f} %", spread_of(numbers));
    }
    fmt::print(out, "\n");

    const std::vector<double>& stage_ms = report.timing.stage_ms;
    const std::span<const char* const> names = stage_names();
    if (stages && !stage_ms.empty()) {
        fmt::print(out, "   ");
        for (std::size_t i = 0; i < std::min(names.size(), stage_ms.size()); ++i)
            fmt::print(out, " {} {:.4f}", names[i], stage_ms[i]);
        fmt::print(out, " (ms)\n");
    }
    std::fflush(out);
}

} // namespace talus::bench
