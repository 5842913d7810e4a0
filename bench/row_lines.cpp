// SPDX-License-Identifier: MIT
// A line is checked when it is read, so that a comparison never stops half-way.
#include "bench/row_lines.h"

#include <array>
#include <fstream>
#include <string>

#include <fmt/format.h>

#include <talus/types.h>

namespace talus::bench {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;

constexpr std::array k_texts{"/scene", "/device/kind", "/device/name"};
constexpr std::array k_numbers{"/step_ms/median", "/quality/max_drift", "/quality/max_penetration"};

[[noreturn]] void refuse(const std::filesystem::path& path, std::size_t line, const std::string& fault) {
    throw Error(fmt::format("{}, line {}: {}; each line must be a report as `talus bench --json` prints it",
                            path.string(), line, fault));
}

void check(const std::filesystem::path& path, std::size_t line, const Json& row) {
    if (!row.is_object()) refuse(path, line, "not a JSON object");
    for (const char* key : k_texts)
        if (!row.contains(Pointer(key)) || !row[Pointer(key)].is_string())
            refuse(path, line, fmt::format("no text at {}", key));
    for (const char* key : k_numbers)
        if (!row.contains(Pointer(key)) || !row[Pointer(key)].is_number())
            refuse(path, line, fmt::format("no number at {}", key));
    if (row["step_ms"]["median"] <= 0.0) refuse(path, line, "/step_ms/median is not positive");
}

} // namespace

std::vector<Json> read_row_lines(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) throw Error(fmt::format("--against: cannot read {}", path.string()));
    std::vector<Json> rows;
    std::string text;
    for (std::size_t line = 1; std::getline(file, text); ++line) {
        if (text.empty()) continue;
        const Json row = Json::parse(text, nullptr, false);
        check(path, line, row);
        rows.push_back(row);
    }
    if (file.bad()) throw Error(fmt::format("--against: cannot read {}", path.string()));
    if (rows.empty()) throw Error(fmt::format("--against: {} holds no report", path.string()));
    return rows;
}

} // namespace talus::bench
