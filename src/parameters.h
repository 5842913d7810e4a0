// SPDX-License-Identifier: MIT
// From a caller's settings to the numbers that kernels read.
#pragma once

#include <talus/settings.h>

#include "step.h"

namespace talus::engine {

/// Passes a step makes.
struct Passes {
    uint least_substeps;
    uint most_substeps;
    uint iterations;
    bool relax;
};
Passes passes_of(const Settings&);

Parameters make_parameters(const Settings&, const StepPlan&);

} // namespace talus::engine
