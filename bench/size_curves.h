// SPDX-License-Identifier: MIT
// Cost against size: what a step takes in time, memory and dispatches, over the number of boxes.
#pragma once

#include <cstdint>
#include <cstdio>

#include "bench/bench_options.h"

namespace talus::bench {

/// Prints each point on `out` when it is measured, and writes all of them as CSV in the end. Returns how many bodies
/// became non-finite, in all runs together. Throws Error for a scene that has no size.
std::uint64_t measure_size_curves(const BenchOptions&, std::FILE* out);

} // namespace talus::bench
