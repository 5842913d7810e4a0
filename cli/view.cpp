// SPDX-License-Identifier: MIT
// talus view: a scene in a window.
#include <memory>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>

#include "cli/commands.h"
#include "viewer/viewer.h"

namespace talus::cli {

void add_view(CLI::App& app, int& status) {
    const auto options = std::make_shared<viewer::ViewOptions>();
    options->simulation.scene = "pool:boxes=300";
    CLI::App* command = app.add_subcommand("view", "Show a scene in a window, to play with; F1 there lists the keys");
    command
        ->add_option("scene", options->simulation.scene,
                     "A built-in scene, as stack:height=30, or a file (.gltf, .glb, .snapshot)")
        ->type_name("SCENE")
        ->capture_default_str();
    add_device_options(*command, options->simulation);
    add_solver_options(*command, options->simulation);
    add_overlay_option(*command, options->overlays);
    command->add_flag("--paused", options->paused, "Begin with the first step still to come");
    command->add_option("--width", options->width, "Of the window, in pixels of a usual screen")
        ->check(CLI::Range(64u, 8192u))
        ->type_name("N")
        ->capture_default_str();
    command->add_option("--height", options->height, "Of the window, in pixels of a usual screen")
        ->check(CLI::Range(64u, 8192u))
        ->type_name("N")
        ->capture_default_str();
    command->add_option("--seconds", options->seconds, "Close the window after so long, and print the frame rate")
        ->check(CLI::Range(0.1, 1.0e6))
        ->type_name("S");
    command->add_flag("--offscreen", options->offscreen,
                      "No window: draw its pictures as fast as can be, a step each, and print the frame rate");
    command->callback([options, &status] {
        viewer::run_viewer(*options);
        status = k_done;
    });
}

} // namespace talus::cli
