// SPDX-License-Identifier: MIT
// Runs a case and times it.
#pragma once

#include <optional>

#include "bench/bench_cases.h"
#include "bench/row.h"

namespace talus::bench {

struct Measurement {
    Row talus;
    std::optional<Row> peer;
};

/// One run from the scene's start. With a peer the two engines take turns, block by block, so that whatever else the
/// machine does slows both.
Measurement measure(const Case&, const BenchOptions&);

} // namespace talus::bench
