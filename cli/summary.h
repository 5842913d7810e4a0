// SPDX-License-Identifier: MIT
// A run's report for people.
#pragma once

#include <string>

#include "cli/report.h"

namespace talus::cli {

/// Several lines, the last one ended too. With `stages`, also how long each stage took.
std::string summary_of(const RunReport&, bool stages);

} // namespace talus::cli
