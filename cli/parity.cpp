// SPDX-License-Identifier: MIT
// talus parity: the CPU and the GPU, stage by stage, one step from the same state.
#include <memory>

#include "cli/commands.h"

namespace talus::cli {
namespace {

constexpr std::uint32_t k_warm_up_steps = 60;

struct Options {
    std::string scene;
    std::uint32_t steps = k_warm_up_steps;
};

int compare(const Options& options) {
    throw Error("cannot compare devices on " + options.scene + ": this build has no comparison");
}

} // namespace

void add_parity(CLI::App& app, int& status) {
    const auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("parity", "Compare CPU and GPU, stage by stage, in one step from the same state");
    command->add_option("scene", options->scene, "A built-in scene or a file (.gltf, .glb)")
        ->required()
        ->type_name("SCENE");
    command->add_option("--steps", options->steps, "Steps to make before the one that is compared")
        ->check(CLI::Range(0u, 1'000'000u))
        ->type_name("N")
        ->capture_default_str();
    command->callback([options, &status] { status = compare(*options); });
}

} // namespace talus::cli
