// SPDX-License-Identifier: MIT
// Scenes that stand from the start: unit boxes in regular arrangements, faces touching, nothing overlapping. Positions
// are multiples of an eighth of a metre, hence exact.
#include <cmath>
#include <cstdint>

#include "scenes/builders.h"
#include "scenes/camera.h"
#include "scenes/scene_builder.h"

namespace talus::scenes {

namespace {

constexpr float k_margin = 20.0f; // m of ground around what stands on it
constexpr Vec3 k_view{0.45f, 0.3f, 1.0f};

constexpr float metres(std::uint32_t count) {
    return static_cast<float>(count);
}

/// Of the smallest square with at least `count` places.
std::uint32_t square_side(std::uint32_t count) {
    return static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(count))));
}

/// One box deep, its lowest row centred at (x, z).
void add_pyramid(SceneBuilder& builder, float x, float z, std::uint32_t base) {
    for (std::uint32_t level = 0; level < base; ++level)
        for (std::uint32_t i = 0; i < base - level; ++i)
            builder.add_box({x + metres(i) + 0.5f - 0.5f * metres(base - level), metres(level) + 0.5f, z});
}

/// `across` × `deep` columns of `height` unit cubes, as many as `count` of them, `pitch` metres from centre to centre.
Scene make_column_field(std::uint32_t across, std::uint32_t deep, std::uint32_t count, std::uint32_t height,
                        float pitch) {
    const float half_x = 0.5f * pitch * metres(across - 1);
    const float half_z = 0.5f * pitch * metres(deep - 1);
    SceneBuilder builder(half_x + k_margin, half_z + k_margin, std::size_t{count} * height);
    for (std::uint32_t column = 0; column < count; ++column) {
        const float x = pitch * metres(column % across) - half_x;
        const float z = pitch * metres(column / across) - half_z;
        for (std::uint32_t level = 0; level < height; ++level)
            builder.add_box({x, metres(level) + 0.5f, z});
    }
    const Bounds region{{-half_x - 0.5f, 0.0f, -half_z - 0.5f}, {half_x + 0.5f, metres(height), half_z + 0.5f}};
    // A wide field is seen from higher up, or its front rows hide the rest.
    const bool wide = metres(deep) * pitch > 2.0f * metres(height);
    return builder.finish(builder.bounds(), frame(region, wide ? Vec3{0.6f, 0.6f, 1.0f} : k_view));
}

} // namespace

Scene make_stack(const Parameters& parameters) {
    return make_column_field(1, 1, 1, parameters.integer("height"), 1.0f);
}

Scene make_columns(const Parameters& parameters) {
    const std::uint32_t side = parameters.integer("side");
    return make_column_field(side, side, side * side, parameters.integer("height"), 2.0f);
}

Scene make_grid(const Parameters& parameters) {
    const std::uint32_t stacks = parameters.integer("stacks");
    const std::uint32_t across = square_side(stacks);
    return make_column_field(across, (stacks + across - 1) / across, stacks, 5, 2.0f);
}

Scene make_pyramid(const Parameters& parameters) {
    const std::uint32_t base = parameters.integer("base");
    const float half = 0.5f * metres(base);
    SceneBuilder builder(half + k_margin, k_margin, std::size_t{base} * (base + 1) / 2);
    add_pyramid(builder, 0.0f, 0.0f, base);
    return builder.finish(builder.bounds(), frame({{-half, 0.0f, -0.5f}, {half, metres(base), 0.5f}}, k_view));
}

Scene make_many_pyramids(const Parameters& parameters) {
    const std::uint32_t side = parameters.integer("side");
    const std::uint32_t base = parameters.integer("base");
    const float pitch_x = metres(base) + 2.0f;
    constexpr float k_pitch_z = 4.0f;
    const float half_x = 0.5f * (pitch_x * metres(side) - 2.0f);
    const float half_z = 0.5f * k_pitch_z * metres(side - 1);
    SceneBuilder builder(half_x + k_margin, half_z + k_margin, std::size_t{side} * side * base * (base + 1) / 2);
    for (std::uint32_t pyramid = 0; pyramid < side * side; ++pyramid)
        add_pyramid(builder, pitch_x * metres(pyramid % side) + 0.5f * metres(base) - half_x,
                    k_pitch_z * metres(pyramid / side) - half_z, base);
    const Bounds region{{-half_x, 0.0f, -half_z - 0.5f}, {half_x, metres(base), half_z + 0.5f}};
    return builder.finish(builder.bounds(), frame(region, {0.6f, 0.6f, 1.0f}));
}

Scene make_worlds(const Parameters& parameters) {
    const std::uint32_t count = parameters.integer("count");
    const std::uint32_t boxes = parameters.integer("boxes");
    // 10 m of empty ground between one block and the next.
    constexpr std::uint32_t k_side = 4;
    constexpr float k_box_pitch = 1.25f, k_world_pitch = 10.0f + k_box_pitch * metres(k_side);
    const std::uint32_t across = square_side(count);
    const float half = 0.5f * k_world_pitch * metres(across);
    SceneBuilder builder(half + k_margin, half + k_margin, std::size_t{count} * boxes);
    for (std::uint32_t world = 0; world < count; ++world)
        for (std::uint32_t i = 0; i < boxes; ++i) {
            const auto along = [&](std::uint32_t cell, std::uint32_t column) {
                return k_world_pitch * (metres(cell) + 0.5f) - half + k_box_pitch * (metres(column) - 1.5f);
            };
            builder.add_box({along(world % across, i % k_side), metres(i / (k_side * k_side)) + 0.5f,
                             along(world / across, i / k_side % k_side)});
        }
    const float top = metres((boxes + k_side * k_side - 1) / (k_side * k_side));
    return builder.finish(builder.bounds(), frame({{-half, 0.0f, -half}, {half, top, half}}, {0.6f, 0.6f, 1.0f}));
}

Scene make_wall(const Parameters& parameters) {
    const std::uint32_t width = parameters.integer("width");
    const std::uint32_t height = parameters.integer("height");
    const float half = 0.5f * metres(width);
    SceneBuilder builder(half + k_margin, k_margin, std::size_t{width + 1} * height);
    for (std::uint32_t level = 0; level < height; ++level) {
        const float y = metres(level) + 0.5f;
        if (level % 2 == 0) {
            for (std::uint32_t i = 0; i < width; ++i)
                builder.add_box({metres(i) + 0.5f - half, y, 0.0f});
            continue;
        }
        // Running bond: half a box further, closed by a half box at each end.
        builder.add_box({0.25f - half, y, 0.0f}, {0.5f, 1.0f, 1.0f});
        for (std::uint32_t i = 1; i < width; ++i)
            builder.add_box({metres(i) - half, y, 0.0f});
        builder.add_box({half - 0.25f, y, 0.0f}, {0.5f, 1.0f, 1.0f});
    }
    return builder.finish(builder.bounds(), frame({{-half, 0.0f, -0.5f}, {half, metres(height), 0.5f}}, k_view));
}

} // namespace talus::scenes
