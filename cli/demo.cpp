// SPDX-License-Identifier: MIT
// talus demo: the thesis's pool of 1,000 boxes (its section 5.1) as a video, a picture and a report.
#include <memory>

#include "cli/commands.h"

namespace talus::cli {

void add_demo(CLI::App& app, int& status) {
    const auto options = std::make_shared<SimulationOptions>();
    options->scene = "pool";
    CLI::App* command = app.add_subcommand(
        "demo", "Drop 1,000 boxes into a pool; writes pool.mp4 and pool.png into the current folder");
    add_device_options(*command, *options);
    command->callback([options, &status] {
        OutputOptions output;
        output.video = "pool.mp4";
        output.image = "pool.png";
        status = run_simulation(*options, output);
    });
}

} // namespace talus::cli
