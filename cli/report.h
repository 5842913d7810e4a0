// SPDX-License-Identifier: MIT
// All that is known of a finished run, and its JSON form, which docs/report.md describes.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/quality.h"
#include "cli/timed_run.h"

namespace talus::cli {

struct BodyCounts {
    std::uint64_t total = 0, dynamic = 0, kinematic = 0, fixed = 0;
};

struct RunReport {
    std::string scene;
    DeviceInfo device;
    Settings settings;
    BodyCounts bodies;
    StepReport last_step;
    Timing timing;
    Quality quality;
    MemoryUse memory;
    std::uint64_t state_hash = 0;

    /// Bodies that are or were not finite: their velocity is frozen, or a number of theirs is not finite now.
    std::uint64_t nonfinite_bodies() const;
    double steps_per_second() const; ///< 0 where no step was made
};

/// Measures the world as it is now.
RunReport make_report(const TimedRun&);

nlohmann::ordered_json to_json(const RunReport&);

/// The hash as reports and summaries show it: 16 hexadecimal digits.
std::string hash_text(std::uint64_t);

} // namespace talus::cli
