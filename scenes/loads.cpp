// SPDX-License-Identifier: MIT
// Heavy bodies that lie on light ones: hard for a solver which passes impulses from contact to contact.
#include <cmath>
#include <cstdint>
#include <vector>

#include "scenes/builders.h"
#include "scenes/camera.h"
#include "scenes/scene_builder.h"

namespace talus::scenes {

Scene make_plate(const Parameters& parameters) {
    // `boxes` cubes in rows of five for four deep, the plate on them, and as many cubes on it, each over one below.
    constexpr float k_pitch = 1.25f, k_thickness = 1.0f; // m
    const std::uint32_t boxes = parameters.integer("boxes");
    const auto across = static_cast<std::uint32_t>(std::ceil(std::sqrt(1.25 * boxes)));
    const std::uint32_t deep = (boxes + across - 1) / across;
    const float half_x = 0.5f * k_pitch * static_cast<float>(across);
    const float half_z = 0.5f * k_pitch * static_cast<float>(deep);

    constexpr float k_margin = 20.0f; // m of ground around the plate
    SceneBuilder builder(half_x + k_margin, half_z + k_margin, 2 * std::size_t{boxes} + 1);
    const auto add_layer = [&](float y) {
        for (std::uint32_t i = 0; i < boxes; ++i)
            builder.add_box({k_pitch * (static_cast<float>(i % across) + 0.5f) - half_x, y,
                             k_pitch * (static_cast<float>(i / across) + 0.5f) - half_z});
    };
    add_layer(0.5f);
    builder.add_box({0.0f, 1.0f + 0.5f * k_thickness, 0.0f}, {2.0f * half_x, k_thickness, 2.0f * half_z});
    add_layer(1.0f + k_thickness + 0.5f);
    const float top = 2.0f + k_thickness;
    return builder.finish(builder.bounds(),
                          frame({{-half_x, 0.0f, -half_z}, {half_x, top, half_z}}, {0.6f, 0.35f, 1.0f}));
}

Scene make_heavy_on_light(const Parameters& parameters) {
    const float wanted = parameters.number("ratio");
    std::vector<float> ratios;
    for (float ratio = 1.0f; ratio < wanted; ratio *= 10.0f)
        ratios.push_back(ratio);
    ratios.push_back(wanted);

    constexpr float k_pitch = 3.0f, k_margin = 20.0f; // m
    const float half = 0.5f * k_pitch * static_cast<float>(ratios.size() - 1);
    SceneBuilder builder(half + k_margin, k_margin, 2 * ratios.size());
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        const float x = k_pitch * static_cast<float>(i) - half;
        builder.add_box({x, 0.5f, 0.0f});
        builder.add_box({x, 1.5f, 0.0f}).density *= ratios[i];
    }
    return builder.finish(builder.bounds(),
                          frame({{-half - 0.5f, 0.0f, -0.5f}, {half + 0.5f, 2.0f, 0.5f}}, {0.3f, 0.3f, 1.0f}));
}

} // namespace talus::scenes
