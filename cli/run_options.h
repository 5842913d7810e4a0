// SPDX-License-Identifier: MIT
// What a simulation from the command line can be told. `run` offers all of it; `demo` and `bench` a part.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <CLI/App.hpp>

#include <talus/settings.h>

#include "render/renderer.h"
#include "scenes/scene.h"

namespace talus::cli {

/// Options that change the simulation itself. What is not given stays as the scene has it.
struct SimulationOptions {
    std::string scene;
    std::uint32_t steps = 600;
    DeviceKind device = DeviceKind::Auto;
    std::uint32_t threads = 0; ///< 0: as many as the machine has
    std::optional<float> dt;   ///< s
    std::optional<std::uint32_t> substeps;
    std::optional<std::uint32_t> iterations;
    std::optional<Stabilisation> stabilisation;
    std::optional<BroadPhase> broad_phase;
    std::optional<SolveOrder> solve_order;
    bool sleeping = false; ///< islands may sleep, whatever the scene has
};

/// Files to write; an empty path is not written.
struct OutputOptions {
    std::filesystem::path report, state, recording, video, image;
    render::Overlays overlays;
    std::uint32_t width = 1280, height = 720; ///< of pictures, in pixels
    double frames_per_second = 30.0;          ///< of the video, for each simulated second
    bool quiet = false;                       ///< nothing on standard output
    bool profile = false;                     ///< stage times in the summary
};

void add_simulation_options(CLI::App& command, SimulationOptions& options);
void add_output_options(CLI::App& command, OutputOptions& options);
void add_device_options(CLI::App& command, SimulationOptions& options);
/// --show: what is drawn besides the bodies.
void add_overlay_option(CLI::App& command, render::Overlays& overlays);
/// The length of a step and how it is solved.
void add_solver_options(CLI::App& command, SimulationOptions& options);

/// The scene's settings with the options on top.
Settings settings_of(const scenes::Scene&, const SimulationOptions&);

} // namespace talus::cli
