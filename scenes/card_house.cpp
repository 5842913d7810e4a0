// SPDX-License-Identifier: MIT
// A house of cards. In each storey pairs of cards lean against each other, and cards lie from pair to pair; the pairs
// of the next storey stand on the middles of these. Every contact is an edge on a face: nothing but friction and the
// triangles that the pairs make with what is below them keeps it up.
//
// The side view of the right card of a pair, whose apex is the origin. It is tilted to the left by the angle a with
// sin a = 7/25 and cos a = 24/25, so that all its corners are exact fractions:
//   u = (−sin a, cos a)   along the card, upwards
//   w = (cos a, sin a)    across it, outwards
// The apex is the upper inner corner, where it touches its partner, the mirror image. The lower inner corner, −L u, is
// its lowest point and stands on what is below. The upper outer corner, t w, is its highest and carries what is above.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "scenes/builders.h"
#include "scenes/camera.h"
#include "scenes/scene_builder.h"

namespace talus::scenes {

namespace {

constexpr double k_thickness = 0.02; // m, t
constexpr double k_length = 1.0;     // m, L
constexpr double k_depth = 0.7;      // m
constexpr double k_sine = 7.0 / 25.0;
constexpr double k_cosine = 24.0 / 25.0;
constexpr double k_pitch = k_length; // m from pair to pair: lying cards meet above the apexes

/// A foot slips where the friction is below its horizontal by its vertical load, which is at most tan a = 0.29: that of
/// a weightless card under a load.
constexpr float k_friction = 0.7f;

constexpr double k_apex_height = k_length * k_cosine;                     // of the apex above the feet
constexpr double k_leaning_height = k_apex_height + k_thickness * k_sine; // of the highest corner above them
constexpr double k_storey = k_leaning_height + k_thickness;

void add_card(SceneBuilder& builder, double x, double y, Quat rotation = {}) {
    // The thickness is along the card's own y axis, its length along x.
    builder.add_box({static_cast<float>(x), static_cast<float>(y), 0.0f},
                    {static_cast<float>(k_length), static_cast<float>(k_thickness), static_cast<float>(k_depth)},
                    rotation);
}

void add_pair(SceneBuilder& builder, double apex_x, double floor) {
    // The centre is half a length below the apex and half a thickness outwards.
    const double across = 0.5 * (k_length * k_sine + k_thickness * k_cosine);
    const double down = 0.5 * (k_length * k_cosine - k_thickness * k_sine);
    // A lying card, turned about z by 90° ± a. sin 45° = cos 45° = √½; of the half of a, tan is 1/7.
    const double half_sine = 1.0 / std::sqrt(50.0), half_cosine = 7.0 / std::sqrt(50.0);
    const double root = std::sqrt(0.5);
    const Quat leans_left{0.0f, 0.0f, static_cast<float>(root * (half_cosine + half_sine)),
                          static_cast<float>(root * (half_cosine - half_sine))};
    const Quat leans_right{0.0f, 0.0f, leans_left.w, leans_left.z};
    add_card(builder, apex_x - across, floor + k_apex_height - down, leans_right);
    add_card(builder, apex_x + across, floor + k_apex_height - down, leans_left);
}

} // namespace

Scene make_card_house(const Parameters& parameters) {
    const std::uint32_t levels = parameters.integer("levels");
    const double half = 0.5 * k_pitch * levels;
    const double height = k_storey * (levels - 1) + k_leaning_height;
    constexpr double k_margin = 5.0; // m of ground around the house
    SceneBuilder builder(static_cast<float>(half + k_margin), static_cast<float>(k_margin),
                         std::size_t{levels} * (3 * levels + 1) / 2, k_friction);
    for (std::uint32_t level = 0; level < levels; ++level) {
        const double floor = k_storey * level;
        const std::uint32_t pairs = levels - level;
        const auto apex = [&](std::uint32_t pair) { return k_pitch * (pair - 0.5 * (pairs - 1)); };
        for (std::uint32_t pair = 0; pair < pairs; ++pair)
            add_pair(builder, apex(pair), floor);
        for (std::uint32_t pair = 0; pair + 1 < pairs; ++pair)
            add_card(builder, 0.5 * (apex(pair) + apex(pair + 1)), floor + k_leaning_height + 0.5 * k_thickness);
    }
    const auto x = static_cast<float>(half), z = static_cast<float>(0.5 * k_depth);
    return builder.finish(builder.bounds(),
                          frame({{-x, 0.0f, -z}, {x, static_cast<float>(height), z}}, {0.35f, 0.2f, 1.0f}));
}

} // namespace talus::scenes
