// SPDX-License-Identifier: MIT
// Now against earlier, case by case: time and quality.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace talus::bench {

/// A change of the median by more than this share is flagged.
inline constexpr double k_notable_change = 0.05;

/// A table, a line for each scene and device of `now`. Several rows of one case are rounds of it.
std::string compare_rows(const std::vector<nlohmann::ordered_json>& earlier,
                         const std::vector<nlohmann::ordered_json>& now);

} // namespace talus::bench
