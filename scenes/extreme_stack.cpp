// SPDX-License-Identifier: MIT
// The thesis's "extreme stacking" (figure 5.3): tall stacks and structures side by side, all standing exactly from the
// start. Each structure is a function of where its middle stands on the ground.
#include <algorithm>
#include <cstdlib>

#include "scenes/builders.h"
#include "scenes/camera.h"
#include "scenes/scene_builder.h"

namespace talus::scenes {

namespace {

void add_stack(SceneBuilder& builder, float x, float z, int height, float from = 0.0f) {
    for (int level = 0; level < height; ++level)
        builder.add_box({x, from + static_cast<float>(level) + 0.5f, z});
}

/// One box deep.
void add_flat_pyramid(SceneBuilder& builder, float x, float z, int base) {
    for (int level = 0; level < base; ++level)
        for (int i = 0; i < base - level; ++i)
            builder.add_box({x + static_cast<float>(i) + 0.5f - 0.5f * static_cast<float>(base - level),
                             static_cast<float>(level) + 0.5f, z});
}

/// Square layers, each one box narrower than the one below. The boxes of a layer stand a little apart: what holds the
/// pyramid is weight, not neighbours.
void add_square_pyramid(SceneBuilder& builder, float x, float z, int base) {
    for (int level = 0; level < base; ++level) {
        const int side = base - level;
        constexpr float k_pitch = 1.05f;
        const float first = 0.5f * k_pitch * static_cast<float>(1 - side);
        for (int row = 0; row < side; ++row)
            for (int i = 0; i < side; ++i)
                builder.add_box({x + first + k_pitch * static_cast<float>(i), static_cast<float>(level) + 0.5f,
                                 z + first + k_pitch * static_cast<float>(row)});
    }
}

/// Running bond of 2 × 1 × 1 m bricks, closed by single cubes at the ends of every other course.
void add_brick_wall(SceneBuilder& builder, float x, float z, int bricks, int courses) {
    const float half = static_cast<float>(bricks);
    for (int course = 0; course < courses; ++course) {
        const float y = static_cast<float>(course) + 0.5f;
        const bool shifted = course % 2 == 1;
        for (int i = 0; i < (shifted ? bricks - 1 : bricks); ++i)
            builder.add_box({x - half + 2.0f * static_cast<float>(i) + (shifted ? 2.0f : 1.0f), y, z},
                            {2.0f, 1.0f, 1.0f});
        if (!shifted) continue;
        builder.add_box({x - half + 0.5f, y, z});
        builder.add_box({x + half - 0.5f, y, z});
    }
}

/// Layers of two beams, each layer across the one below.
void add_log_tower(SceneBuilder& builder, float x, float z, int layers) {
    for (int layer = 0; layer < layers; ++layer) {
        const float y = static_cast<float>(layer) + 0.5f;
        for (const float side : {-1.0f, 1.0f}) {
            if (layer % 2 == 0)
                builder.add_box({x, y, z + side}, {3.0f, 1.0f, 1.0f});
            else
                builder.add_box({x + side, y, z}, {1.0f, 1.0f, 3.0f});
        }
    }
}

/// Storeys of `spans` + 1 pillars, a beam from pillar to pillar (meeting over the middle of each), and the next storey.
void add_bridge(SceneBuilder& builder, float x, float z, int spans, int storeys, int pillar_height) {
    constexpr float k_span = 4.0f;
    constexpr float k_beam = 0.5f;
    const float half = 0.5f * k_span * static_cast<float>(spans);
    float floor = 0.0f;
    for (int storey = 0; storey < storeys; ++storey) {
        for (int i = 0; i <= spans; ++i)
            add_stack(builder, x - half + k_span * static_cast<float>(i), z, pillar_height, floor);
        floor += static_cast<float>(pillar_height);
        for (int i = 0; i < spans; ++i)
            builder.add_box({x - half + k_span * (static_cast<float>(i) + 0.5f), floor + 0.5f * k_beam, z},
                            {k_span, k_beam, 1.0f});
        floor += k_beam;
    }
}

} // namespace

Scene make_extreme_stack(const Parameters& parameters) {
    SceneBuilder builder(60.0f, 40.0f, 700);

    constexpr int k_stacks = 12;
    const int tallest = static_cast<int>(parameters.integer("height"));
    for (int i = 0; i < k_stacks; ++i) {
        const int from_middle = (std::abs(2 * i - (k_stacks - 1)) - 1) / 2;
        add_stack(builder, 4.0f * static_cast<float>(i) - 22.0f, -9.0f, tallest - from_middle);
    }
    add_flat_pyramid(builder, 10.0f, -4.0f, 15);
    add_brick_wall(builder, -12.0f, -4.0f, 8, 12);
    add_bridge(builder, -10.0f, 1.0f, 5, 3, 3);
    add_log_tower(builder, 4.0f, 1.0f, 14);
    add_log_tower(builder, 16.0f, 1.0f, 10);
    add_square_pyramid(builder, 10.0f, 4.0f, 6);

    const float top = static_cast<float>(std::max(tallest, 15));
    return builder.finish(builder.bounds(), frame({{-23.0f, 0.0f, -9.5f}, {23.0f, top, 7.0f}}, {0.25f, 0.3f, 1.0f}));
}

} // namespace talus::scenes
