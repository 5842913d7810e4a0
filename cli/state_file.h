// SPDX-License-Identifier: MIT
// Every body as it is, as JSON. docs/report.md describes the file.
#pragma once

#include <string>

#include "cli/timed_run.h"

namespace talus::cli {

std::string state_json(const TimedRun&);

} // namespace talus::cli
