// SPDX-License-Identifier: MIT
// The commands of the program, one file each. A command registers its options, does its work when CLI11 calls it back,
// and reports failure by an exception or through `status`, the program's exit status.
#pragma once

#include <CLI/App.hpp>

#include "cli/run_options.h"

namespace talus::cli {

inline constexpr int k_done = 0;
inline constexpr int k_failed_own_check = 1; ///< a body became non-finite, or devices disagree
inline constexpr int k_bad_usage = 2;        ///< also a bad file, or a device that cannot be had
inline constexpr int k_interrupted = 130;    ///< as shells report SIGINT

void add_demo(CLI::App&, int& status);
void add_run(CLI::App&, int& status);
void add_view(CLI::App&, int& status);
void add_bench(CLI::App&, int& status);
void add_parity(CLI::App&, int& status);
void add_scenes(CLI::App&, int& status);
void add_devices(CLI::App&, int& status);

/// What `run` does, for commands that choose the options themselves. Returns the exit status.
int run_simulation(const SimulationOptions&, const OutputOptions&);

} // namespace talus::cli
