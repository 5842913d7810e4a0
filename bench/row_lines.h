// SPDX-License-Identifier: MIT
// What `talus bench --json` printed at an earlier time.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

namespace talus::bench {

/// One object a line, each with the keys that a comparison needs. Throws Error that names the line.
std::vector<nlohmann::ordered_json> read_row_lines(const std::filesystem::path&);

} // namespace talus::bench
