// SPDX-License-Identifier: MIT
// The options' names, limits and help texts.
#include "cli/run_options.h"

#include <algorithm>
#include <cmath>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

#include "cli/words.h"

namespace talus::cli {
namespace {

constexpr std::uint32_t k_baumgarte_iterations = 10;
constexpr std::uint32_t k_largest_side = 8192; // pixels of a picture
constexpr double k_most_frames = 1000.0;       // of a video, a second

template <typename T> std::string list_words(Words<T> words, std::string_view between) {
    std::string list;
    for (const auto& [word, meaning] : words)
        list += (list.empty() ? "" : std::string(between)) + std::string(word);
    return list;
}

/// An option that takes one of a few words.
template <typename T, typename Target>
void add_choice(CLI::App& command, const std::string& name, Target& target, Words<T> words, const std::string& help) {
    command
        .add_option_function<std::string>(
            name,
            [name, &target, words](const std::string& given) {
                for (const auto& [word, meaning] : words) {
                    if (word == given) {
                        target = meaning;
                        return;
                    }
                }
                throw CLI::ValidationError(name, fmt::format("'{}' is not one of {}", given, list_words(words, ", ")));
            },
            help)
        ->type_name(list_words(words, "|"));
}

std::string check_seconds(const std::string& given) {
    float seconds = 0.0f;
    if (CLI::detail::lexical_cast(given, seconds) && std::isfinite(seconds) && seconds > 0.0f) return {};
    return fmt::format("'{}' is not a positive number", given);
}

std::string check_named(const std::string& given) {
    return given.empty() ? "the name of the file is empty" : "";
}

/// What a file holds follows its option, not its name: another ending would be a lie.
CLI::Validator ends_in(const std::string& ending) {
    return {[ending](const std::string& given) -> std::string {
                if (CLI::detail::to_lower(std::filesystem::path(given).extension().string()) == ending) return {};
                return fmt::format("'{}' does not end in {}, the only kind of file that is written here", given,
                                   ending);
            },
            ""};
}

std::string list_overlay_names(std::string_view between) {
    std::string list;
    for (const render::OverlayInfo& overlay : render::list_overlays())
        list += (list.empty() ? "" : std::string(between)) + std::string(overlay.name);
    return list;
}

void set_overlays(render::Overlays& overlays, const std::string& list) {
    for (const std::string& word : CLI::detail::split(list, ',')) {
        const auto found = std::ranges::find(render::list_overlays(), word, &render::OverlayInfo::name);
        if (found == render::list_overlays().end())
            throw CLI::ValidationError("--show", fmt::format("'{}' is not one of {}", word, list_overlay_names(", ")));
        overlays.*found->shown = true;
    }
}

} // namespace

void add_device_options(CLI::App& command, SimulationOptions& options) {
    add_choice(command, "--device", options.device, device_words(),
               "Where the step runs; auto: the GPU where there is a real one, otherwise the CPU");
    command.add_option("--threads", options.threads, "Threads of the CPU device; 0: as many as the machine has")
        ->check(CLI::Range(0u, 1024u))
        ->type_name("N");
}

void add_simulation_options(CLI::App& command, SimulationOptions& options) {
    command.add_option("scene", options.scene, "A built-in scene, as stack:height=30, or a file (.gltf, .glb)")
        ->required()
        ->type_name("SCENE");
    command.add_option("--steps", options.steps, "Steps to simulate")
        ->check(CLI::Range(0u, 1'000'000'000u))
        ->type_name("N")
        ->capture_default_str();
    add_device_options(command, options);
    add_solver_options(command, options);
}

void add_solver_options(CLI::App& command, SimulationOptions& options) {
    command.add_option("--dt", options.dt, "Length of a step in seconds; by default 1/60")
        ->check(CLI::Validator(check_seconds, ""))
        ->type_name("S");
    command
        .add_option("--substeps", options.substeps,
                    "Sub-steps of every step, for soft stabilisation; by default 8, and as many as the load on an "
                    "island asks for")
        ->check(CLI::Range(1u, 1000u))
        ->type_name("N");
    command
        .add_option("--iterations", options.iterations,
                    fmt::format("Solver passes: in a sub-step for soft, by default 1; in a step for baumgarte, by "
                                "default {}",
                                k_baumgarte_iterations))
        ->check(CLI::Range(1u, 10'000u))
        ->type_name("N");
    add_choice(command, "--stabilisation", options.stabilisation, stabilisation_words(),
               "How overlap is undone: sub-steps with soft contacts, or a velocity bias");
    add_choice(command, "--solve-order", options.solve_order, solve_order_words(),
               "How a pass goes through the contacts: in batches that share no body, or one after the other");
    add_choice(command, "--broad-phase", options.broad_phase, broad_phase_words(),
               "How pairs are found: sweep and prune, a tree of bounding boxes, every pair, or what is fastest");
    command.add_flag("--sleeping", options.sleeping, "Let islands at rest sleep until something touches them");
}

void add_overlay_option(CLI::App& command, render::Overlays& overlays) {
    command
        .add_option_function<std::string>(
            "--show", [&overlays](const std::string& list) { set_overlays(overlays, list); },
            "What to draw over the bodies, separated by commas: " + list_overlay_names(", "))
        ->type_name("LIST");
}

void add_output_options(CLI::App& command, OutputOptions& options) {
    command.add_option("--report", options.report, "Write counts, times and quality as JSON")
        ->check(CLI::Validator(check_named, ""))
        ->type_name("FILE.json");
    command.add_option("--state", options.state, "Write every body as it is at the end as JSON")
        ->check(CLI::Validator(check_named, ""))
        ->type_name("FILE.json");
    command.add_option("--record", options.recording, "Write every pose of every step (docs/recording.md)")
        ->check(CLI::Validator(check_named, ""))
        ->type_name("FILE");
    command.add_option("--video", options.video, "Write a video")->check(ends_in(".mp4"))->type_name("FILE.mp4");
    command.add_option("--image", options.image, "Write a picture of the end")
        ->check(ends_in(".png"))
        ->type_name("FILE.png");
    add_overlay_option(command, options.overlays);
    command.add_option("--width", options.width, "Pixels of a picture")
        ->check(CLI::Range(16u, k_largest_side))
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--height", options.height, "Pixels of a picture")
        ->check(CLI::Range(16u, k_largest_side))
        ->type_name("N")
        ->capture_default_str();
    command.add_option("--fps", options.frames_per_second, "Pictures of the video for each simulated second")
        ->check(CLI::Range(1.0, k_most_frames))
        ->type_name("N")
        ->capture_default_str();
    command.add_flag("--profile", options.profile, "Print how long each stage takes");
    command.add_flag("--quiet", options.quiet, "Print nothing on standard output");
}

Settings settings_of(const scenes::Scene& scene, const SimulationOptions& options) {
    Settings settings = scene.settings;
    if (options.dt) settings.dt = *options.dt;
    if (options.substeps) settings.substeps = settings.max_substeps = *options.substeps;
    if (options.solve_order) settings.solve_order = *options.solve_order;
    if (options.broad_phase) settings.broad_phase = *options.broad_phase;
    if (options.sleeping) settings.sleeping = true;
    if (options.stabilisation) {
        settings.stabilisation = *options.stabilisation;
        if (settings.stabilisation == Stabilisation::Baumgarte) settings.iterations = k_baumgarte_iterations;
    }
    if (options.iterations) settings.iterations = *options.iterations;
    return settings;
}

} // namespace talus::cli
