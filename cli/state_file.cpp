// SPDX-License-Identifier: MIT
// Written by hand, one line a body: a JSON tree of a million bodies would take gigabytes, and numbers of single
// precision need no more digits than lead back to the same bits.
#include "cli/state_file.h"

#include <cmath>
#include <initializer_list>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/words.h"

namespace talus::cli {
namespace {

using Buffer = fmt::memory_buffer;

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void append_numbers(Buffer& out, std::string_view key, std::initializer_list<float> numbers) {
    fmt::format_to(std::back_inserter(out), ", \"{}\": [", key);
    std::string_view separator;
    for (const float number : numbers) {
        out.append(separator);
        if (std::isfinite(number)) {
            fmt::format_to(std::back_inserter(out), "{}", number);
        } else {
            out.append(std::string_view("null")); // JSON has no other word for it
        }
        separator = ", ";
    }
    out.push_back(']');
}

} // namespace

std::string state_json(const TimedRun& run) {
    const World& world = run.world();
    const std::vector<BodyId> ids = world.bodies();
    const std::vector<Pose> poses = world.poses();
    const std::vector<Velocity> velocities = world.velocities();
    Buffer out;
    fmt::format_to(std::back_inserter(out), "{{\n\"scene\": {},\n\"steps\": {},\n\"dt\": {},\n\"bodies\": [",
                   quoted(run.scene().name), run.timing().steps, world.settings().dt);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto& [position, rotation] = poses[i];
        const auto& [linear, angular] = velocities[i];
        fmt::format_to(std::back_inserter(out), "{}\n{{\"name\": {}, \"kind\": \"{}\"", i == 0 ? "" : ",",
                       quoted(run.scene().bodies[i].name), word_of(body_kind_words(), world.kind(ids[i])));
        append_numbers(out, "position", {position.x, position.y, position.z});
        append_numbers(out, "rotation", {rotation.x, rotation.y, rotation.z, rotation.w});
        append_numbers(out, "linear_velocity", {linear.x, linear.y, linear.z});
        append_numbers(out, "angular_velocity", {angular.x, angular.y, angular.z});
        fmt::format_to(std::back_inserter(out), ", \"sleeping\": {}}}", world.is_asleep(ids[i]));
    }
    out.append(std::string_view("\n]\n}\n"));
    return fmt::to_string(out);
}

} // namespace talus::cli
