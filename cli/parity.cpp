// SPDX-License-Identifier: MIT
// talus parity: the CPU and the GPU, stage by stage, one step from the same state.
#include <memory>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/run_options.h"
#include "parity.h"
#include "scenes/scene.h"

namespace talus::cli {
namespace {

constexpr std::uint32_t k_warm_up_steps = 60;

int compare(const SimulationOptions& options) {
    const scenes::Scene scene = scenes::make_scene(options.scene);
    std::vector<BodyDefinition> definitions;
    for (const scenes::NamedBody& body : scene.bodies)
        definitions.push_back(body.definition);
    const engine::ParityReport report =
        engine::compare_devices(definitions, settings_of(scene, options), options.steps);

    fmt::print("{}, step {}: the same state on the CPU and on the GPU, compared after each stage\n", scene.name,
               options.steps + 1);
    fmt::print("{:<18}{:<20}{:>12}{:>16}{:>14}{:>14}\n", "stage", "buffer", "words", "integers differ", "floats differ",
               "largest error");
    for (const engine::BufferParity& row : report.rows)
        fmt::print("{:<18}{:<20}{:>12}{:>16}{:>14}{:>14.2g}\n", row.stage, row.buffer, row.words, row.integers_differ,
                   row.floats_differ, row.largest_error);
    const bool agree = report.integers_agree() && report.largest_error() <= engine::k_parity_tolerance;
    fmt::print("{}: integers {}, floats within {:.2g} (allowed {:.2g})\n", agree ? "agree" : "DISAGREE",
               report.integers_agree() ? "exact" : "differ", report.largest_error(), engine::k_parity_tolerance);
    return agree ? 0 : 1;
}

} // namespace

void add_parity(CLI::App& app, int& status) {
    const auto options = std::make_shared<SimulationOptions>();
    options->steps = k_warm_up_steps;
    CLI::App* command =
        app.add_subcommand("parity", "Compare CPU and GPU, stage by stage, in one step from the same state");
    command->add_option("scene", options->scene, "A built-in scene or a file (.gltf, .glb)")
        ->required()
        ->type_name("SCENE");
    command->add_option("--steps", options->steps, "Steps to make before the one that is compared")
        ->check(CLI::Range(0u, 1'000'000u))
        ->type_name("N")
        ->capture_default_str();
    add_solver_options(*command, *options);
    command->callback([options, &status] { status = compare(*options); });
}

} // namespace talus::cli
