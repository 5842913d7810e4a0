// SPDX-License-Identifier: MIT
// A case is a scene on a kind of device, or in another engine. What else differs between the two runs is named beside
// the ratio, as it may be its reason.
#include "bench/comparison.h"

#include <algorithm>
#include <array>
#include <iterator>

#include <fmt/format.h>

#include "bench/bench_table.h"
#include "cli/summary.h"

namespace talus::bench {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;

constexpr std::array k_conditions{"/device/name", "/threads",       "/steps",       "/dt",         "/substeps",
                                  "/iterations",  "/stabilisation", "/solve_order", "/broad_phase"};

bool same_case(const Json& a, const Json& b) {
    return a["scene"] == b["scene"] && a["device"]["kind"] == b["device"]["kind"];
}

std::vector<Json> rounds_of(const std::vector<Json>& rows, const Json& wanted) {
    std::vector<Json> rounds;
    std::ranges::copy_if(rows, std::back_inserter(rounds), [&](const Json& row) { return same_case(row, wanted); });
    return rounds;
}

double median_ms(const std::vector<Json>& rounds) {
    std::vector<double> medians;
    for (const Json& row : rounds)
        medians.push_back(row["step_ms"]["median"]);
    return median_of(medians);
}

Json value_at(const Json& row, const char* key) {
    return row.contains(Pointer(key)) ? row[Pointer(key)] : Json();
}

std::string length_at(const Json& row, const char* key) {
    const Json length = value_at(row, key);
    return length.is_number() ? cli::length_text(length) : "–";
}

std::string remarks(const Json& earlier, const Json& now) {
    std::string text;
    for (const char* key : k_conditions) {
        const Json before = value_at(earlier, key), after = value_at(now, key);
        const bool is_known = !before.is_null() && !after.is_null(); // an older file lacks what came later
        if (is_known && before != after)
            text += fmt::format(" {} was {}, is {};", key + 1, before.dump(), after.dump());
    }
    if (!text.empty()) text.pop_back();
    return text;
}

std::string verdict(double ratio) {
    if (ratio > 1.0 + k_notable_change) return "SLOWER";
    if (ratio < 1.0 - k_notable_change) return "faster";
    return "";
}

} // namespace

std::string compare_rows(const std::vector<Json>& earlier, const std::vector<Json>& now) {
    std::size_t width = 5;
    for (const Json& row : now)
        width = std::max(width, row["scene"].get_ref<const std::string&>().size());
    std::string text = fmt::format("{:<{}}  {:<6} {:>10} {:>10} {:>6} {:<6} {:>20} {:>20}\n", "scene", width, "device",
                                   "earlier ms", "now ms", "ratio", "", "drift: earlier, now", "overlap");
    const auto pair = [](const Json& before, const Json& after, const char* key) {
        return length_at(before, key) + ", " + length_at(after, key);
    };
    for (std::size_t i = 0; i < now.size(); ++i) {
        const std::vector<Json> after = rounds_of(now, now[i]);
        const bool told = std::any_of(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(i),
                                      [&](const Json& row) { return same_case(row, now[i]); });
        if (told) continue;
        const std::string start = fmt::format("{:<{}}  {:<6}", now[i]["scene"].get_ref<const std::string&>(), width,
                                              now[i]["device"]["kind"].get_ref<const std::string&>());
        const std::vector<Json> before = rounds_of(earlier, now[i]);
        if (before.empty()) {
            text += fmt::format("{} {:>10} {:>10.4f}  not measured earlier\n", start, "–", median_ms(after));
            continue;
        }
        const double ratio = median_ms(after) / median_ms(before);
        text += fmt::format(
            "{} {:>10.4f} {:>10.4f} {:>6.3f} {:<6} {:>20} {:>20} {}\n", start, median_ms(before), median_ms(after),
            ratio, verdict(ratio), pair(before.back(), after.back(), "/quality/max_drift"),
            pair(before.back(), after.back(), "/quality/max_penetration"), remarks(before.back(), after.back()));
    }
    return text;
}

} // namespace talus::bench
