// SPDX-License-Identifier: MIT
// A scene in a world, stepped and timed. docs/report.md says what the times mean.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include <talus/world.h>

#include "scenes/scene.h"

namespace talus::cli {

/// Wall-clock times of the steps so far.
struct Timing {
    std::uint64_t steps = 0; ///< all
    std::uint64_t timed_steps = 0;
    double seconds = 0.0;         ///< of the timed steps, without what lies between them
    std::vector<double> step_ms;  ///< of the sampled steps
    std::vector<double> stage_ms; ///< means over the sampled steps; empty where not profiled
};

struct Statistics {
    double median = 0.0, mean = 0.0, p95 = 0.0, max = 0.0;
};

/// Zeros for no samples.
Statistics statistics_of(std::vector<double> samples);

class TimedRun {
public:
    /// `steps` is how many will be made: it decides how far apart the samples are.
    TimedRun(scenes::Scene, const Settings&, const WorldOptions&, std::uint32_t steps);

    const World& world() const noexcept { return simulated; }
    const scenes::Scene& scene() const noexcept { return source; }

    /// Removes the next `count` dynamic bodies of the scene, in turn, and adds each again as the scene has it. Part of
    /// the time of the step that follows.
    void replace_bodies(std::uint32_t count);
    /// The next step searches for all pairs, whether that is due or not. Not part of its time.
    void search_anew();
    /// On a GPU it returns while the step is on its way, unless the step is sampled. The first step is not timed where
    /// more follow: it compiles the kernels.
    void step();
    /// Waits for the steps and stops the clock until the next one: to be called before anything else is done.
    void settle();

    const Timing& timing() const noexcept { return times; }

private:
    using Clock = std::chrono::steady_clock;

    void sample_step();
    void replace_now();

    scenes::Scene source;
    World simulated;
    Timing times;
    std::uint32_t planned_steps;
    std::uint32_t sample_interval;
    bool profile;
    std::vector<BodyId> ids; ///< of the scene's bodies
    std::uint32_t replacing = 0;
    std::size_t next_replaced = 0;
    bool running = false;
    Clock::time_point start;
};

} // namespace talus::cli
