// SPDX-License-Identifier: MIT
// Both engines begin from the same bodies and make the same number of steps; neither one's first step is timed.
#include "bench/measurement.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "bench/peer.h"
#include "cli/interrupt.h"
#include "cli/progress_bar.h"
#include "cli/timed_run.h"
#include "cli/words.h"

namespace talus::bench {
namespace {

constexpr std::uint32_t k_block = 50; // steps that one engine makes before it is the other one's turn

class TimedPeer {
public:
    explicit TimedPeer(const cli::TimedRun& talus)
        : scene(talus.scene()), start(cli::sample_bodies(talus.world())),
          peer(make_bullet(scene, talus.world().settings(), start)) {}

    void step() {
        const Clock::time_point before = Clock::now();
        peer->step();
        const std::chrono::duration<double> time = Clock::now() - before;
        if (++times.steps == 1) return;
        ++times.timed_steps;
        times.seconds += time.count();
        times.step_ms.push_back(1e3 * time.count());
    }

    Row row(const cli::RunReport& talus) const {
        const PeerDescription about = peer->description();
        const PeerCounts counts = peer->counts();
        std::vector<Vec3> places;
        for (const cli::BodySample& body : start)
            places.push_back(body.pose.position);

        Row row;
        row.runs_on = k_bullet;
        row.is_peer = true;
        row.report.scene = scene.name;
        row.report.device.name = about.name;
        row.report.device.driver = about.version;
        row.report.device.threads = about.threads;
        row.report.settings = talus.settings;
        row.report.settings.iterations = about.iterations;
        row.report.bodies = talus.bodies;
        row.report.last_step.pairs = counts.pairs;
        row.report.last_step.manifolds = counts.manifolds;
        row.report.last_step.contacts = counts.contacts;
        row.report.timing = times;
        row.report.quality = cli::measure_quality(peer->samples(), places, scene.bounds);
        return row;
    }

private:
    using Clock = std::chrono::steady_clock;
    const scenes::Scene& scene;
    std::vector<cli::BodySample> start;
    std::unique_ptr<Peer> peer;
    cli::Timing times;
};

} // namespace

Measurement measure(const Case& bench_case, const BenchOptions& options) {
    const std::uint32_t steps = options.simulation.steps;
    const bool has_peer = !options.peer.empty();
    scenes::Scene scene = scenes::make_scene(bench_case.scene);
    const Settings settings = cli::settings_of(scene, options.simulation);
    WorldOptions world_options;
    world_options.device = bench_case.device;
    world_options.threads = options.simulation.threads;
    world_options.profile = options.stages;
    cli::TimedRun run(std::move(scene), settings, world_options, steps);
    std::unique_ptr<TimedPeer> peer;
    if (has_peer) peer = std::make_unique<TimedPeer>(run);

    cli::ProgressBar progress(steps, true);
    for (std::uint32_t done = 0; done < steps;) {
        const std::uint32_t block = has_peer ? std::min(k_block, steps - done) : steps;
        for (std::uint32_t i = 0; i < block; ++i) {
            cli::check_interrupt();
            run.replace_bodies(options.churn);
            if (options.searches_always) run.search_anew();
            run.step();
            progress.show(done + (has_peer ? i / 2 : i));
        }
        run.settle();
        for (std::uint32_t i = 0; has_peer && i < block; ++i) {
            cli::check_interrupt();
            peer->step();
            progress.show(done + (block + i) / 2);
        }
        done += block;
    }

    Measurement measured;
    measured.talus.report = cli::make_report(run);
    measured.talus.runs_on = cli::word_of(cli::device_words(), measured.talus.report.device.kind);
    if (peer) measured.peer = peer->row(measured.talus.report);
    return measured;
}

} // namespace talus::bench
