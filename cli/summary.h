// SPDX-License-Identifier: MIT
// A run's report for people.
#pragma once

#include <string>

#include "cli/report.h"

namespace talus::cli {

/// Several lines, the last one ended too. With `stages`, also how long each stage took.
std::string summary_of(const RunReport&, bool stages);

/// Lengths from nanometres to kilometres in a unit that keeps the digits few.
std::string length_text(double metres);

} // namespace talus::cli
