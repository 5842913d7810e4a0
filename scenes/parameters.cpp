// SPDX-License-Identifier: MIT
// Reads parameters and says what is wrong with them in words.
#include "scenes/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace talus::scenes {

namespace {

/// Whole numbers are written out in full: 1000000, not 1e+06.
std::string number_text(double value) {
    if (value == std::floor(value)) return std::to_string(static_cast<long long>(value));
    char text[32];
    const auto [end, error] = std::to_chars(std::begin(text), std::end(text), value);
    return error == std::errc{} ? std::string(text, end) : std::string("?");
}

std::string allowed(const Parameter& parameter) {
    return (parameter.integer ? "a whole number from " : "a number from ") + number_text(parameter.minimum) + " to " +
           number_text(parameter.maximum);
}

std::vector<std::string> parameter_names(const SceneInfo& info) {
    std::vector<std::string> names;
    for (const Parameter& parameter : info.parameters)
        names.push_back(parameter.name);
    return names;
}

std::string describe_parameters(const SceneInfo& info) {
    if (info.parameters.empty()) return "It has none.";
    std::vector<std::string> entries;
    for (const Parameter& parameter : info.parameters)
        entries.push_back(parameter.name + " (" + parameter.meaning + ", " + allowed(parameter) + ")");
    return "Its parameters are: " + join(entries) + ".";
}

std::size_t find_parameter(const SceneInfo& info, const std::string& name) {
    const auto found = std::ranges::find(info.parameters, name, &Parameter::name);
    if (found != info.parameters.end()) return static_cast<std::size_t>(found - info.parameters.begin());
    const std::string nearest = nearest_name(name, parameter_names(info));
    throw Error("scene '" + info.name + "' has no parameter '" + name + "'" +
                (nearest.empty() ? ". " : "; did you mean '" + nearest + "'? ") + describe_parameters(info));
}

double read_value(const SceneInfo& info, const Parameter& parameter, std::string_view text) {
    const auto fail = [&] {
        throw Error("scene '" + info.name + "': " + parameter.name + " (" + parameter.meaning + ") must be " +
                    allowed(parameter) + ", not '" + std::string(text) + "'");
    };
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) fail();
    if (value < parameter.minimum || value > parameter.maximum) fail();
    if (parameter.integer && value != std::floor(value)) fail();
    return value;
}

} // namespace

Parameters::Parameters(const SceneInfo& scene, std::string_view text) : info(scene) {
    for (const Parameter& parameter : info.parameters)
        values.push_back(parameter.default_value);
    std::vector<bool> given(values.size(), false);
    bool more = !text.empty();
    while (more) {
        const std::size_t comma = text.find(',');
        const std::string_view entry = text.substr(0, comma);
        more = comma != std::string_view::npos;
        if (more) text.remove_prefix(comma + 1);
        const std::size_t equals = entry.find('=');
        if (equals == std::string_view::npos || equals == 0)
            throw Error("scene '" + info.name + "': '" + std::string(entry) + "' is not of the form name=value. " +
                        describe_parameters(info));
        const std::size_t index = find_parameter(info, std::string(entry.substr(0, equals)));
        if (given[index]) throw Error("scene '" + info.name + "': " + info.parameters[index].name + " is given twice");
        given[index] = true;
        values[index] = read_value(info, info.parameters[index], entry.substr(equals + 1));
    }
}

double Parameters::value_of(std::string_view name) const {
    const auto found = std::ranges::find(info.parameters, name, &Parameter::name);
    return values.at(static_cast<std::size_t>(found - info.parameters.begin()));
}

std::uint32_t Parameters::integer(std::string_view name) const {
    return static_cast<std::uint32_t>(value_of(name));
}

float Parameters::number(std::string_view name) const {
    return static_cast<float>(value_of(name));
}

std::string Parameters::text() const {
    std::string result;
    for (std::size_t i = 0; i < values.size(); ++i)
        result += (i == 0 ? "" : ",") + info.parameters[i].name + "=" + number_text(values[i]);
    return result;
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
    std::string nearest;
    std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        // Levenshtein's distance, one row of the table at a time.
        std::vector<std::size_t> row(candidate.size() + 1);
        std::iota(row.begin(), row.end(), std::size_t{0});
        for (std::size_t i = 0; i < name.size(); ++i) {
            std::size_t diagonal = row[0];
            row[0] = i + 1;
            for (std::size_t j = 0; j < candidate.size(); ++j) {
                const std::size_t changed = diagonal + (name[i] == candidate[j] ? 0 : 1);
                diagonal = row[j + 1];
                row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
            }
        }
        if (row.back() < least && row.back() < candidate.size()) {
            least = row.back();
            nearest = candidate;
        }
    }
    return nearest;
}

std::string join(const std::vector<std::string>& parts) {
    std::string result;
    for (const std::string& part : parts)
        result += (result.empty() ? "" : ", ") + part;
    return result;
}

} // namespace talus::scenes
