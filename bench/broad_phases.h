// SPDX-License-Identifier: MIT
// The broad phases side by side: what each needs for the same bodies, from a hundred to a million of them; uniform
// sizes in a field of stacks, uniform sizes in a heap, and very different sizes.
#pragma once

#include <cstdio>

#include "bench/bench_options.h"

namespace talus::bench {

/// Prints each point on `out` when it is measured, and writes all of them as CSV in the end. Returns how many bodies
/// became non-finite, in all runs together.
std::uint64_t measure_broad_phases(const BenchOptions&, std::FILE* out);

} // namespace talus::bench
