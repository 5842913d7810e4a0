// SPDX-License-Identifier: MIT
// The program talus: which command, and how it ended.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include <talus/version.h>

#include "cli/commands.h"
#include "cli/interrupt.h"

int main(int argc, char** argv) {
    using namespace talus::cli;
    CLI::App app("Rigid-body physics in OpenGL compute shaders, and the same engine on the CPU", "talus");
    app.set_version_flag("--version", talus::version());
    app.require_subcommand(0, 1); // with at least one asked for, CLI11 has no word for a command that there is not
    int status = k_done;
    add_demo(app, status);
    add_run(app, status);
    add_view(app, status);
    add_bench(app, status);
    add_parity(app, status);
    add_scenes(app, status);
    add_devices(app, status);

    app.footer("In the folder of the sources, ./talus test builds and runs every test.");

    catch_interrupts();
    try {
        app.parse(argc, argv);
        if (!app.get_subcommands().empty()) return status;
        fmt::print(stderr, "{}", app.help());
        return k_bad_usage;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? k_done : k_bad_usage;
    } catch (const Interrupted& error) {
        fmt::print(stderr, "talus: {}\n", error.what());
        return k_interrupted;
    } catch (const std::exception& error) {
        fmt::print(stderr, "talus: {}\n", error.what());
        return k_bad_usage;
    }
}
