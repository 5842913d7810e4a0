// SPDX-License-Identifier: MIT
// Flat boxes on a tilted plate. With the friction μ they stay where the tangent of the angle is below μ, and otherwise
// slide down with g (sin θ − μ cos θ) onto the ground.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "scenes/builders.h"
#include "scenes/camera.h"
#include "scenes/scene_builder.h"
#include "scenes/turns.h"

namespace talus::scenes {

namespace {

constexpr Vec3 k_box{1.0f, 0.5f, 1.0f}; // m; so flat that it slides at each allowed angle before it tips over
constexpr std::uint32_t k_across = 10;  // boxes side by side
constexpr double k_pitch = 2.0;         // m from box to box
constexpr double k_runway = 10.0;       // m of plate below the lowest row
constexpr double k_plate = 1.0;         // m thick

} // namespace

Scene make_slope(const Parameters& parameters) {
    const std::uint32_t boxes = parameters.integer("boxes");
    const double angle = parameters.number("angle") * std::numbers::pi / 180.0;
    const std::uint32_t across = std::min(boxes, k_across);
    const std::uint32_t rows = (boxes + across - 1) / across;
    const double length = k_runway + k_pitch * rows, width = k_pitch * across;
    const double sine = std::sin(angle), cosine = std::cos(angle);

    // `along` leads up the plate from the middle of its upper side, `above` away from it. The plate's lower edge lies
    // on the ground, at the left.
    const auto place = [&](double along, double above, double z) {
        return Vec3{static_cast<float>(along * cosine - above * sine),
                    static_cast<float>((0.5 * length + along) * sine + above * cosine), static_cast<float>(z)};
    };
    const Quat tilt = turn_about_z(angle);
    const auto half_x = static_cast<float>(0.5 * length), half_z = static_cast<float>(0.5 * width);

    constexpr float k_margin = 30.0f; // m of ground around the plate
    SceneBuilder builder(half_x + k_margin, half_z + k_margin, boxes, parameters.number("friction"));
    const auto half_plate = static_cast<float>(0.5 * k_plate);
    builder.add_wall("plate", {-half_x, -half_plate, -half_z}, {half_x, half_plate, half_z}).pose = {
        place(0.0, -0.5 * k_plate, 0.0), tilt};
    for (std::uint32_t i = 0; i < boxes; ++i)
        builder.add_box(place(k_runway + k_pitch * (i / across + 0.5) - 0.5 * length, 0.5 * k_box.y,
                              k_pitch * (i % across + 0.5) - 0.5 * width),
                        k_box, tilt);
    const float top = place(0.5 * length, k_box.y, 0.0).y;
    return builder.finish(builder.bounds(),
                          frame({{-half_x, 0.0f, -half_z}, {half_x, top, half_z}}, {-0.7f, 0.5f, 1.0f}));
}

} // namespace talus::scenes
