// SPDX-License-Identifier: MIT
// A row of dominoes along a sine-like bend: their directions swing from side to side, so that the row never meets
// itself however long it is. The first one is already on its way over.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "scenes/builders.h"
#include "scenes/camera.h"
#include "scenes/scene_builder.h"
#include "scenes/turns.h"

namespace talus::scenes {

namespace {

constexpr Vec3 k_domino{0.15f, 1.0f, 0.5f}; // m; as flat and wide as those of the game, and twenty times as large
constexpr double k_pitch = 0.5;             // m from centre to centre along the row
constexpr double k_wave = 80.0;             // dominoes until the row points the same way again

/// rad/s. To get its centre above its lower edge, (√(h² + t²) − h)/2 = 5.6 mm higher, takes 0.57 rad/s.
constexpr float k_push = 1.5f;

struct Place {
    double x, z, heading; // heading: angle of the row to the x axis, about y
};

std::vector<Place> lay_row(std::uint32_t count, double largest_heading) {
    std::vector<Place> row;
    const auto heading = [&](double i) { return largest_heading * std::cos(2.0 * std::numbers::pi * i / k_wave); };
    double x = 0.0, z = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) {
        row.push_back({x, z, heading(i)});
        x += k_pitch * std::cos(heading(i + 0.5));
        z -= k_pitch * std::sin(heading(i + 0.5));
    }
    return row;
}

/// How a domino moves that turns over its lower edge, towards its heading.
Velocity falling(double heading) {
    const auto forward_x = static_cast<float>(std::cos(heading)), forward_z = static_cast<float>(-std::sin(heading));
    const float forward = 0.5f * k_domino.y * k_push; // of the centre, half a height above the edge
    const float up = 0.5f * k_domino.x * k_push;      // and half a thickness behind it
    return {{forward * forward_x, up, forward * forward_z}, {k_push * forward_z, 0.0f, -k_push * forward_x}};
}

} // namespace

Scene make_dominoes(const Parameters& parameters) {
    const std::vector<Place> row =
        lay_row(parameters.integer("count"), parameters.number("bend") * std::numbers::pi / 180.0);
    double least = 0.0, most = 0.0;
    for (const Place& place : row) {
        least = std::min(least, place.z);
        most = std::max(most, place.z);
    }
    const double middle_x = 0.5 * row.back().x, middle_z = 0.5 * (least + most);
    const auto half_x = static_cast<float>(middle_x + 0.5), half_z = static_cast<float>(0.5 * (most - least) + 0.5);

    constexpr float k_margin = 40.0f; // m of ground around the row
    SceneBuilder builder(half_x + k_margin, half_z + k_margin, row.size());
    for (const Place& place : row) {
        BodyDefinition& domino = builder.add_box(
            {static_cast<float>(place.x - middle_x), 0.5f * k_domino.y, static_cast<float>(place.z - middle_z)},
            k_domino, turn_about_y(place.heading));
        if (&place == &row.front()) domino.velocity = falling(place.heading);
    }
    return builder.finish(builder.bounds(),
                          frame({{-half_x, 0.0f, -half_z}, {half_x, k_domino.y, half_z}}, {-1.0f, 0.35f, 0.4f}));
}

} // namespace talus::scenes
