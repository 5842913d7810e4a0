// SPDX-License-Identifier: MIT
// talus devices: where a world could run on this machine.
#include <fmt/format.h>

#include <talus/world.h>

#include "cli/commands.h"
#include "cli/words.h"

namespace talus::cli {
namespace {

void print_devices() {
    for (const DeviceInfo& device : list_devices()) {
        fmt::print("{:<8}{}{}\n", word_of(device_words(), device.kind), device.name.empty() ? "none" : device.name,
                   device.in_software ? " (in software)" : "");
        if (!device.driver.empty()) fmt::print("        {}\n", device.driver);
        if (device.threads > 0) fmt::print("        {} threads\n", device.threads);
        if (!device.why.empty()) fmt::print("        {}\n", device.why);
    }
}

} // namespace

void add_devices(CLI::App& app, int& /*status*/) {
    CLI::App* command = app.add_subcommand("devices", "List the devices that a simulation can run on");
    command->callback(print_devices);
}

} // namespace talus::cli
