// SPDX-License-Identifier: MIT
// A sampled step waits for the one before it and for itself. The CPU device has nothing to hide behind a wait, so there
// every step is a sample; a GPU is sampled now and then only, since each wait keeps it from working ahead.
#include "cli/timed_run.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace talus::cli {
namespace {

constexpr std::uint32_t k_fewest_samples = 50, k_most_samples = 250;

/// Of a GPU: at most a tenth of the steps where that is enough for a median.
std::uint32_t interval_of_samples(std::uint32_t steps) {
    return std::max(1u, steps / std::clamp(steps / 10, k_fewest_samples, k_most_samples));
}

double milliseconds(std::chrono::steady_clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

} // namespace

Statistics statistics_of(std::vector<double> samples) {
    if (samples.empty()) return {};
    std::sort(samples.begin(), samples.end());
    const std::size_t count = samples.size();
    Statistics statistics;
    statistics.median = 0.5 * (samples[(count - 1) / 2] + samples[count / 2]);
    statistics.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(count);
    statistics.p95 = samples[(count * 95 + 99) / 100 - 1]; // the smallest that 95 % do not exceed
    statistics.max = samples.back();
    return statistics;
}

/// The first steps are measured too, and shall be made as all others.
static WorldOptions with_all_kernels(WorldOptions options) {
    options.wait_for_kernels = true;
    return options;
}

TimedRun::TimedRun(scenes::Scene scene, const Settings& settings, const WorldOptions& options, std::uint32_t steps)
    : source(std::move(scene)), simulated(settings, with_all_kernels(options)), planned_steps(steps),
      profile(options.profile) {
    const bool runs_ahead = simulated.device().kind == DeviceKind::Gpu;
    sample_interval = runs_ahead ? interval_of_samples(steps) : 1u;

    std::vector<BodyDefinition> definitions;
    definitions.reserve(source.bodies.size());
    for (const scenes::NamedBody& body : source.bodies)
        definitions.push_back(body.definition);
    simulated.make_gl_current(); // spares each step the change of context
    ids = simulated.add(definitions);
    simulated.wait();
}

void TimedRun::replace_bodies(std::uint32_t count) {
    replacing = count;
}

void TimedRun::search_anew() {
    settle();
    const Settings settings = simulated.settings();
    Settings other = settings;
    other.broad_phase = settings.broad_phase == BroadPhase::Bvh ? BroadPhase::SweepAndPrune : BroadPhase::Bvh;
    simulated.set_settings(other); // pairs that another broad phase has found are not kept
    simulated.set_settings(settings);
}

void TimedRun::replace_now() {
    const std::size_t body_count = ids.size();
    std::vector<BodyDefinition> definitions;
    std::vector<std::size_t> places;
    for (std::size_t looked = 0; looked < body_count && places.size() < replacing; ++looked) {
        const std::size_t place = next_replaced++ % body_count;
        const BodyDefinition& definition = source.bodies[place].definition;
        if (definition.kind != BodyKind::Rigid) continue;
        simulated.remove(ids[place]);
        definitions.push_back(definition);
        places.push_back(place);
    }
    const std::vector<BodyId> added = simulated.add(definitions);
    for (std::size_t i = 0; i < added.size(); ++i)
        ids[places[i]] = added[i];
    replacing = 0;
}

void TimedRun::step() {
    ++times.steps;
    if (times.steps == 1 && planned_steps > 1) {
        replace_now();
        simulated.step(1);
        simulated.wait();
        return;
    }
    if (!running) {
        running = true;
        start = Clock::now();
    }
    ++times.timed_steps;
    if (times.steps % sample_interval == 0) {
        sample_step();
    } else {
        replace_now();
        simulated.step(1);
    }
}

void TimedRun::settle() {
    if (!running) return;
    simulated.wait();
    times.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    running = false;
}

void TimedRun::sample_step() {
    simulated.wait();
    const Clock::time_point before = Clock::now();
    replace_now();
    simulated.step(1);
    simulated.wait();
    times.step_ms.push_back(milliseconds(Clock::now() - before));
    if (!profile) return;

    const std::vector<double> stages = simulated.report().stage_ms;
    times.stage_ms.resize(stages.size());
    const double weight = 1.0 / static_cast<double>(times.step_ms.size());
    for (std::size_t i = 0; i < stages.size(); ++i)
        times.stage_ms[i] += weight * (stages[i] - times.stage_ms[i]);
}

} // namespace talus::cli
