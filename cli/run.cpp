// SPDX-License-Identifier: MIT
// talus run: a scene, some steps, and what came of it.
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/frame_outputs.h"
#include "cli/interrupt.h"
#include "cli/output_file.h"
#include "cli/progress_bar.h"
#include "cli/report.h"
#include "cli/state_file.h"
#include "cli/summary.h"
#include "cli/timed_run.h"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t k_many_pictures = 10; // about a second in software

std::vector<fs::path> files_of(const OutputOptions& output) {
    std::vector<fs::path> files;
    for (const fs::path* path : {&output.report, &output.state, &output.recording, &output.video, &output.image})
        if (!path->empty()) files.push_back(*path);
    return files;
}

void check_files_differ(const std::vector<fs::path>& files) {
    for (std::size_t i = 0; i < files.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (fs::weakly_canonical(fs::absolute(files[i])) == fs::weakly_canonical(fs::absolute(files[j])))
                throw Error("two outputs would be written to the same file, " + files[i].string());
}

/// Said at the start, because it takes long and nothing else shows outside of a terminal that the program is at work.
void announce_drawing(const FrameOutputs& outputs, const SimulationOptions& options, const OutputOptions& output) {
    const std::uint64_t pictures = outputs.pictures_in_software(options.steps);
    if (pictures < k_many_pictures || output.quiet) return;
    fmt::print(stderr,
               "talus: drawing {} pictures of {} × {} pixels in software, for want of a GPU; this takes a while\n",
               pictures, output.width, output.height);
}

void simulate(TimedRun& run, FrameOutputs& outputs, const SimulationOptions& options, bool quiet) {
    ProgressBar progress(options.steps, !quiet);
    for (std::uint32_t done = 0;; ++done) {
        if (outputs.wants(done)) {
            run.settle();
            outputs.add(done);
        }
        if (done == options.steps) break;
        check_interrupt();
        run.step();
        progress.show(done + 1);
    }
    run.settle();
}

} // namespace

int run_simulation(const SimulationOptions& options, const OutputOptions& output) {
    scenes::Scene scene = scenes::make_scene(options.scene);
    for (const std::string& warning : scene.warnings)
        fmt::print(stderr, "talus: {}: {}\n", scene.name, warning);
    const std::vector<fs::path> files = files_of(output);
    check_files_differ(files);
    for (const fs::path& file : files)
        check_output(file);

    WorldOptions world_options;
    world_options.device = options.device;
    world_options.threads = options.threads;
    world_options.profile = output.profile || !output.report.empty();
    const Settings settings = settings_of(scene, options);
    if (options.substeps && settings.stabilisation == Stabilisation::Baumgarte)
        fmt::print(stderr, "talus: --substeps has no effect with --stabilisation baumgarte\n");

    TimedRun run(std::move(scene), settings, world_options, options.steps);
    FrameOutputs outputs(output, run);
    announce_drawing(outputs, options, output);
    simulate(run, outputs, options, output.quiet);

    const RunReport report = make_report(run);
    outputs.finish();
    if (!output.state.empty()) write_output(output.state, state_json(run));
    if (!output.report.empty()) write_output(output.report, to_json(report).dump(2) + "\n");
    if (!output.quiet) {
        fmt::print("{}", summary_of(report, output.profile));
        for (const fs::path& file : files)
            fmt::print("{:<12}{}\n", "wrote", file.string());
    }
    if (report.nonfinite_bodies() == 0) return k_done;
    fmt::print(stderr, "talus: {} of {} bodies became non-finite and were frozen\n", report.nonfinite_bodies(),
               report.bodies.total);
    return k_failed_own_check;
}

void add_run(CLI::App& app, int& status) {
    struct Options {
        SimulationOptions simulation;
        OutputOptions output;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("run", "Simulate a scene");
    add_simulation_options(*command, options->simulation);
    add_output_options(*command, options->output);
    command->callback([options, &status] { status = run_simulation(options->simulation, options->output); });
}

} // namespace talus::cli
