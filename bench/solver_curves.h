// SPDX-License-Identifier: MIT
// The thesis's experiment with the solver's accuracy: how far bodies drift, and what a step costs, over the number of
// passes that the solver makes; Baumgarte stabilisation over its iterations, soft contacts over their sub-steps;
// contacts solved in coloured batches and one after the other.
#pragma once

#include <cstdio>

#include "bench/bench_options.h"

namespace talus::bench {

/// Prints each point on `out` when it is measured, and writes all of them as CSV in the end. Returns how many bodies
/// became non-finite, in all runs together.
std::uint64_t measure_solver_curves(const BenchOptions&, std::FILE* out);

} // namespace talus::bench
