// SPDX-License-Identifier: MIT
// Scenes that fall: boxes hang in loose layers, randomly turned, over a basin of static walls, and come to rest in it.
// Each box has a cell of its own that is as wide as the largest box's diagonal, so that none overlap at the start.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scenes/builders.h"
#include "scenes/camera.h"
#include "scenes/random.h"
#include "scenes/scene_builder.h"

namespace talus::scenes {

namespace {

constexpr float k_wall_thickness = 2.0f; // m
constexpr float k_jitter = 0.05f;        // m, to each side of the middle of a cell
constexpr float k_diagonal = 1.733f;     // of a unit cube, rounded up
constexpr float k_packing = 0.55f;       // of the volume is filled by boxes at rest; random piles reach 0.55 to 0.65

/// Cells for `boxes`, `across` × `across` in a layer and about a quarter as many layers.
struct Cells {
    std::uint32_t across = 1;
    std::uint32_t layers = 1;
    float pitch = 1.0f; // m

    Cells(std::uint32_t boxes, float largest_edge)
        : pitch(std::ceil(10.0f * (k_diagonal * largest_edge + 2.0f * k_jitter)) / 10.0f) {
        const auto capacity = [](std::uint64_t side) { return side * side * std::max<std::uint64_t>(1, side / 4); };
        while (capacity(across) < boxes)
            ++across;
        layers = (boxes + across * across - 1) / (across * across);
    }

    float height() const { return pitch * static_cast<float>(layers); }
    float width() const { return pitch * static_cast<float>(across); }

    Vec3 centre(std::uint32_t index, Random& random) const {
        const std::uint32_t in_layer = index % (across * across);
        const auto along = [&](std::uint32_t cell) {
            return pitch * (static_cast<float>(cell) + 0.5f) + random.between(-k_jitter, k_jitter);
        };
        const float x = along(in_layer % across) - 0.5f * width();
        const float y = along(index / (across * across));
        const float z = along(in_layer / across) - 0.5f * width();
        return {x, y, z};
    }
};

void add_basin(SceneBuilder& builder, float half, float height) {
    const float outer = half + k_wall_thickness;
    builder.add_wall("left wall", {-outer, 0.0f, -outer}, {-half, height, outer});
    builder.add_wall("right wall", {half, 0.0f, -outer}, {outer, height, outer});
    builder.add_wall("back wall", {-half, 0.0f, -outer}, {half, height, -half});
    builder.add_wall("front wall", {-half, 0.0f, half}, {half, height, outer});
}

/// Escaped is also what gets as far as the middle of a wall, or over it.
Scene finish_pour(SceneBuilder& builder, float half, float wall_height) {
    Bounds bounds = builder.bounds();
    const float middle = half + 0.5f * k_wall_thickness;
    bounds.lower.x = bounds.lower.z = -middle;
    bounds.upper.x = bounds.upper.z = middle;
    const float outer = half + k_wall_thickness;
    const Bounds region{{-outer, 0.0f, -outer}, {outer, wall_height, outer}};
    return builder.finish(bounds, frame(region, {0.3f, 1.1f, 1.0f}));
}

/// Boxes with edges from `smallest` to `largest` fall into a basin that holds half as much again as they fill at rest,
/// one on top, and the splash: the higher they fall from, the higher some jump.
Scene make_pour(std::uint32_t boxes, std::uint64_t seed, float smallest, float largest) {
    const Cells cells(boxes, largest);
    const float half = 0.5f * cells.width();
    const float mean_edge = 0.5f * (smallest + largest);
    const float filled =
        static_cast<float>(boxes) * mean_edge * mean_edge * mean_edge / (k_packing * cells.width() * cells.width());
    const float wall_height = std::ceil(1.5f * filled + largest + 0.125f * cells.height());

    SceneBuilder builder(half + 20.0f, half + 20.0f, boxes);
    add_basin(builder, half, wall_height);
    Random random(seed);
    for (std::uint32_t i = 0; i < boxes; ++i) {
        const Vec3 centre = cells.centre(i, random);
        Vec3 size{largest, largest, largest};
        if (smallest < largest) {
            size.x = random.between(smallest, largest);
            size.y = random.between(smallest, largest);
            size.z = random.between(smallest, largest);
        }
        builder.add_box(centre, size, random.rotation());
    }

    return finish_pour(builder, half, wall_height);
}

} // namespace

Scene make_pool(const Parameters& parameters) {
    return make_pour(parameters.integer("boxes"), parameters.integer("seed"), 1.0f, 1.0f);
}

Scene make_pile(const Parameters& parameters) {
    return make_pour(parameters.integer("boxes"), parameters.integer("seed"), 0.5f, 1.5f);
}

Scene make_rubble(const Parameters& parameters) {
    // Cubes of edges that double. Half the edge is four times the number, so that each size covers the ground as often.
    constexpr float k_smallest = 0.125f, k_cell = k_diagonal + 0.1f; // m; edges that a cell is wide
    constexpr float k_layers = 2.0f;
    const std::uint32_t boxes = parameters.integer("boxes");
    std::vector<float> edges{k_smallest};
    while (2.0f * edges.back() <= k_smallest * parameters.number("ratio") && edges.size() < boxes)
        edges.push_back(2.0f * edges.back()); // at least one box of each
    std::vector<std::uint32_t> counts(edges.size());
    double share = boxes * 0.75 / (1.0 - std::pow(0.25, static_cast<double>(edges.size())));
    std::uint32_t rest = boxes;
    for (std::size_t i = 0; i < edges.size(); ++i, share /= 4.0) {
        const bool last = i + 1 == edges.size();
        const auto left = static_cast<std::uint32_t>(edges.size() - 1 - i); // for those larger
        counts[i] = last ? rest : std::clamp(static_cast<std::uint32_t>(share), 1u, rest - left);
        rest -= counts[i];
    }

    float area = 0.0f, volume = 0.0f;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const float number = static_cast<float>(counts[i]), cell = k_cell * edges[i];
        area = std::max(area, std::max(number / k_layers, std::min(number, 1.0f)) * cell * cell);
        volume += number * edges[i] * edges[i] * edges[i];
    }
    const float width = std::ceil(std::sqrt(area) + k_cell * k_smallest), half = 0.5f * width;
    SceneBuilder builder(half + 20.0f, half + 20.0f, boxes);
    const float wall_height = std::ceil(2.0f * volume / (k_packing * area) + 4.0f * edges.back());
    add_basin(builder, half, wall_height);

    Random random(parameters.integer("seed"));
    float bottom = 0.0f;
    for (std::size_t i = edges.size(); i-- > 0;) { // the largest fall first
        const float edge = edges[i], cell = k_cell * edge, jitter = 0.05f * edge;
        const auto across = static_cast<std::uint32_t>(width / cell);
        const float start = -0.5f * cell * static_cast<float>(across);
        for (std::uint32_t k = 0; k < counts[i]; ++k) {
            const auto along = [&](float from, std::uint32_t place) {
                return from + cell * (static_cast<float>(place) + 0.5f) + random.between(-jitter, jitter);
            };
            const float x = along(start, k % across);
            const float y = along(bottom, k / (across * across));
            const float z = along(start, k / across % across);
            builder.add_box({x, y, z}, {edge, edge, edge}, random.rotation());
        }
        bottom += cell * static_cast<float>((counts[i] + across * across - 1) / (across * across));
    }
    return finish_pour(builder, half, wall_height);
}

} // namespace talus::scenes
