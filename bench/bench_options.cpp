// SPDX-License-Identifier: MIT
// The options' names, limits and help texts.
#include "bench/bench_options.h"

#include <algorithm>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

#include "bench/peer.h"
#include "cli/words.h"

namespace talus::bench {
namespace {

constexpr std::uint32_t k_steps = 300;

std::vector<DeviceKind> parse_devices(const std::string& list) {
    std::vector<DeviceKind> devices;
    std::string allowed;
    for (const auto& [word, device] : cli::device_words())
        allowed += (allowed.empty() ? "" : ", ") + std::string(word);
    for (const std::string& given : CLI::detail::split(list, ',')) {
        const auto words = cli::device_words();
        const auto found = std::ranges::find(words, given, [](const auto& entry) { return entry.first; });
        if (found == words.end())
            throw CLI::ValidationError("--devices", fmt::format("'{}' is not one of {}", given, allowed));
        if (std::ranges::find(devices, found->second) != devices.end())
            throw CLI::ValidationError("--devices", fmt::format("'{}' is listed twice", given));
        devices.push_back(found->second);
    }
    return devices;
}

std::string check_peer(const std::string& given) {
    if (given == k_bullet) return {};
    return fmt::format("'{}' is not one of {}", given, k_bullet);
}

} // namespace

void add_bench_options(CLI::App& command, BenchOptions& options) {
    cli::SimulationOptions& simulation = options.simulation;
    simulation.steps = k_steps;
    command
        .add_option("scenes", options.scenes,
                    "Built-in scenes, as stack:height=30, or files (.gltf, .glb); by default a list that suits "
                    "the devices")
        ->type_name("SCENE");
    command
        .add_option_function<std::string>(
            "--devices", [&options](const std::string& list) { options.devices = parse_devices(list); },
            "Where each scene runs, separated by commas; by default auto")
        ->type_name("cpu,gpu,hybrid");
    command.add_option("--steps", simulation.steps, "Steps of each run; the first is not timed")
        ->check(CLI::Range(2u, 1'000'000u))
        ->type_name("N")
        ->capture_default_str();
    command
        .add_option("--threads", simulation.threads,
                    "Threads of the CPU device; by default as many as the machine has, with --peer one")
        ->check(CLI::Range(1u, 1024u))
        ->type_name("N");
    CLI::Option* repeats = command.add_option("--repeat", options.repeats, "Runs of each case, to show the spread")
                               ->check(CLI::Range(1u, 1000u))
                               ->type_name("N")
                               ->capture_default_str();
    CLI::Option* stages = command.add_flag("--stages", options.stages, "Print how long each stage takes");
    CLI::Option* peer =
        command.add_option("--peer", options.peer, "Run the same scenes in another engine too, in turns with Talus")
            ->check(CLI::Validator(check_peer, ""))
            ->type_name(std::string(k_bullet));
    CLI::Option* json = command.add_flag(
        "--json", options.json, "Write one report a line on standard output; the table goes to standard error");
    CLI::Option* against =
        command.add_option("--against", options.against, "Compare with an earlier output of --json")->type_name("FILE");
    cli::add_solver_options(command, simulation);
    CLI::Option* curves =
        command
            .add_option("--solver-curves", options.solver_curves,
                        "Measure drift and time over the passes of the solver instead, and write them as CSV")
            ->type_name("FILE.csv");
    CLI::Option* broad_phases = command
                                    .add_option("--broad-phases", options.broad_phases,
                                                "Measure the broad phases side by side instead, and write it as CSV")
                                    ->type_name("FILE.csv");
    CLI::Option* churn =
        command
            .add_option("--churn", options.churn, "Before each step, remove so many bodies and add the same ones again")
            ->check(CLI::Range(1u, 1'000'000u))
            ->type_name("N")
            ->excludes(peer);
    CLI::Option* size_curves =
        command
            .add_option("--size-curves", options.size_curves,
                        "Measure grid and pile, or those of them that are given, over the number of boxes instead, and "
                        "write time, memory, dispatches and quality as CSV")
            ->type_name("FILE.csv");
    command
        .add_option("--sizes", options.sizes,
                    "Numbers of boxes for --size-curves, separated by commas; by default 100 to 30,000")
        ->delimiter(',')
        ->check(CLI::Range(1u, 2'000'000u))
        ->type_name("N,N")
        ->needs(size_curves);
    for (CLI::Option* other :
         {repeats, stages, peer, json, against, command.get_option("--broad-phase"), curves, churn, size_curves})
        broad_phases->excludes(other);
    for (CLI::Option* other : {repeats, stages, peer, json, against, curves, churn})
        size_curves->excludes(other);
    curves->excludes(churn);
    for (CLI::Option* other :
         {repeats, stages, peer, json, against, command.get_option("--iterations"), command.get_option("--substeps"),
          command.get_option("--stabilisation"), command.get_option("--solve-order"), command.get_option("--sleeping")})
        curves->excludes(other);
}

} // namespace talus::bench
