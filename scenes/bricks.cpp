// SPDX-License-Identifier: MIT
// Large structures of bricks in running bond, built to the sizes for which other engines publish figures, and steel
// spheres that roll into them. Bricks of a course lie some centimetres apart: what carries them is the course below.
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

constexpr Vec3 k_brick{1.0f, 0.5f, 0.5f}; // m
constexpr float k_margin = 300.0f;        // m of ground around what stands on it: a sphere may roll on for ten seconds
constexpr float k_speed = 25.0f;          // m/s of the spheres

float course_centre(std::uint32_t course) {
    return k_brick.y * (static_cast<float>(course) + 0.5f);
}

/// Rolls on the ground without slipping, along x or z.
void add_rolling_sphere(SceneBuilder& builder, float radius, float x, float z, Vec3 direction) {
    BodyDefinition& sphere = builder.add_sphere({x, radius, z}, radius);
    sphere.density = k_steel;
    sphere.velocity.linear = {k_speed * direction.x, 0.0f, k_speed * direction.z};
    sphere.velocity.angular = {k_speed / radius * direction.z, 0.0f, -k_speed / radius * direction.x};
}

} // namespace

Scene make_brick_ring(const Parameters& parameters) {
    constexpr double k_gap = 0.02;                // m from brick to brick and from ring to ring
    constexpr std::uint32_t k_courses_a_step = 4; // the wall gets one ring thinner on its outside after each four
    constexpr float k_sphere = 4.0f;              // m, radius
    constexpr float k_before = 12.5f;             // m that it rolls before it hits: half a second

    const std::uint32_t courses = parameters.integer("courses");
    const std::uint32_t rings = (courses + k_courses_a_step - 1) / k_courses_a_step;
    const double inner_radius = parameters.integer("radius");
    const auto outer = static_cast<float>(inner_radius + rings * (k_brick.z + k_gap) + 0.5);
    // As many bricks as lie 2 cm apart along the inner faces of rings without gaps between them. That gives the
    // published count. The rings themselves are 2 cm apart, since a brick's ends reach 1.6 mm beyond the circle of its
    // outer face.
    const auto bricks_in = [&](std::uint32_t ring) {
        return static_cast<std::uint32_t>(2.0 * std::numbers::pi * (inner_radius + ring * k_brick.z) /
                                          (k_brick.x + k_gap));
    };

    std::size_t count = 0;
    for (std::uint32_t course = 0; course < courses; ++course)
        for (std::uint32_t ring = 0; ring < rings - course / k_courses_a_step; ++ring)
            count += bricks_in(ring);
    SceneBuilder builder(outer + k_margin, outer + k_margin, count);
    add_rolling_sphere(builder, k_sphere, static_cast<float>(inner_radius) - k_sphere - k_before, 0.0f,
                       {1.0f, 0.0f, 0.0f});
    for (std::uint32_t course = 0; course < courses; ++course) {
        for (std::uint32_t ring = 0; ring < rings - course / k_courses_a_step; ++ring) {
            const double centre_radius = inner_radius + ring * (k_brick.z + k_gap) + 0.5 * k_brick.z;
            const std::uint32_t bricks = bricks_in(ring);
            for (std::uint32_t i = 0; i < bricks; ++i) {
                const double angle = 2.0 * std::numbers::pi * (i + 0.5 * (course % 2)) / bricks;
                // The brick's length lies along the circle: at the angle 0, on the x axis, it is turned by 90°.
                builder.add_box({static_cast<float>(centre_radius * std::cos(angle)), course_centre(course),
                                 static_cast<float>(-centre_radius * std::sin(angle))},
                                k_brick, turn_about_y(angle + 0.5 * std::numbers::pi));
            }
        }
    }
    const float top = k_brick.y * static_cast<float>(courses);
    return builder.finish(
        builder.bounds(),
        frame({{-outer, 0.0f, -outer}, {outer, std::max(top, 2.0f * k_sphere), outer}}, {-0.5f, 0.5f, 1.0f}));
}

Scene make_brick_gables(const Parameters& parameters) {
    constexpr float k_gap = 0.03125f; // m from brick to brick: more than contacts reach ahead, and exact
    constexpr float k_brick_pitch = k_brick.x + k_gap;
    constexpr float k_sphere = 4.3f;    // m, radius
    constexpr float k_between = 2.0f;   // m from the end of a wall to the next in its row
    constexpr float k_row_pitch = 4.0f; // m from row to row
    constexpr float k_before = 12.5f;   // m that the spheres roll before they hit: half a second

    const std::uint32_t across = parameters.integer("across");
    const std::uint32_t rows = parameters.integer("rows");
    const std::uint32_t base = parameters.integer("base");
    const float wall_pitch = k_brick_pitch * static_cast<float>(base) - k_gap + k_between;
    const float half_x = 0.5f * (wall_pitch * static_cast<float>(across) - k_between);
    const float half_z = 0.5f * k_row_pitch * static_cast<float>(rows - 1);
    const auto wall_x = [&](std::uint32_t wall) {
        return wall_pitch * (static_cast<float>(wall) - 0.5f * static_cast<float>(across - 1));
    };

    SceneBuilder builder(half_x + k_margin, half_z + k_margin, std::size_t{across} * rows * base * (base + 1) / 2);
    // Two walls of each row are hit in their middles, a quarter of the row from its ends; where there is one wall, one.
    const float start_z = -half_z - 0.5f * k_brick.z - k_before - k_sphere;
    add_rolling_sphere(builder, k_sphere, wall_x(across / 4), start_z, {0.0f, 0.0f, 1.0f});
    if (across > 1) add_rolling_sphere(builder, k_sphere, wall_x(across - 1 - across / 4), start_z, {0.0f, 0.0f, 1.0f});
    for (std::uint32_t row = 0; row < rows; ++row)
        for (std::uint32_t wall = 0; wall < across; ++wall)
            for (std::uint32_t course = 0; course < base; ++course)
                for (std::uint32_t i = 0; i < base - course; ++i) {
                    const float x =
                        k_brick_pitch * (static_cast<float>(i) - 0.5f * static_cast<float>(base - course - 1));
                    builder.add_box(
                        {wall_x(wall) + x, course_centre(course), k_row_pitch * static_cast<float>(row) - half_z},
                        k_brick);
                }
    const float top = std::max(k_brick.y * static_cast<float>(base), 2.0f * k_sphere);
    return builder.finish(builder.bounds(),
                          frame({{-half_x, 0.0f, start_z - k_sphere}, {half_x, top, half_z}}, {0.6f, 0.5f, -1.0f}));
}

} // namespace talus::scenes
