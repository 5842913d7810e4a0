// SPDX-License-Identifier: MIT
// What `talus bench` can be told.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "cli/run_options.h"

namespace talus::bench {

struct BenchOptions {
    std::vector<std::string> scenes;                      ///< empty: a list that suits the devices
    std::vector<DeviceKind> devices = {DeviceKind::Auto}; ///< each scene runs on each of them
    /// How each run is made. Its scene and device are set for each case; steps and threads are those asked for.
    cli::SimulationOptions simulation;
    std::uint32_t repeats = 1;
    std::string peer; ///< another engine by its name; empty: none
    bool stages = false;
    bool json = false;
    std::filesystem::path against; ///< lines of an earlier `--json`; empty: none
    // CSV files of the other experiments; empty: the benchmark
    std::filesystem::path solver_curves;
    std::filesystem::path broad_phases;
    std::filesystem::path size_curves;
    std::vector<std::uint32_t> sizes; ///< boxes, for the size curves
    std::uint32_t churn = 0;          ///< bodies removed and added before each step
    bool searches_always = false;     ///< each step searches for all pairs, as broad phases are compared by that
};

void add_bench_options(CLI::App& command, BenchOptions& options);

} // namespace talus::bench
