// SPDX-License-Identifier: MIT
// talus scenes: the built-in scenes and what can be chosen about them.
#include <fmt/format.h>

#include "cli/commands.h"
#include "scenes/scene.h"

namespace talus::cli {
namespace {

void print_scenes() {
    for (const scenes::SceneInfo& scene : scenes::list_scenes()) {
        fmt::print("{:<16}{}\n", scene.name, scene.summary);
        for (const scenes::Parameter& parameter : scene.parameters)
            fmt::print("    {:<20}{}, {} to {}\n", fmt::format("{}={:.10g}", parameter.name, parameter.default_value),
                       parameter.meaning, fmt::format("{:.10g}", parameter.minimum),
                       fmt::format("{:.10g}", parameter.maximum));
    }
}

} // namespace

void add_scenes(CLI::App& app, int& /*status*/) {
    CLI::App* command = app.add_subcommand("scenes", "List the built-in scenes, their parameters and limits");
    command->callback(print_scenes);
}

} // namespace talus::cli
