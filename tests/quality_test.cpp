// SPDX-License-Identifier: MIT
// The measuring code itself: overlap against closed forms and against the definition of the penetration depth, pairs
// against trying all of them, energy and momenta against hand calculation.
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "cli/candidate_pairs.h"
#include "cli/overlap.h"
#include "cli/quality.h"
#include "cli/timed_run.h"

namespace talus::cli {
namespace {

constexpr scenes::Bounds k_bounds{{-100.0f, -100.0f, -100.0f}, {100.0f, 100.0f, 100.0f}};

Quat rotation_about_z(float angle) {
    return {0.0f, 0.0f, std::sin(angle / 2), std::cos(angle / 2)};
}

PlacedShape box(Vec3 size, Vec3 position, Quat rotation = {}) {
    return place(Box{size}, {position, rotation});
}

PlacedShape sphere(float radius, Vec3 position) {
    return place(Sphere{radius}, {position, {}});
}

BodySample body(Vec3 position, BodyKind kind = BodyKind::Rigid) {
    BodySample sample;
    sample.kind = kind;
    sample.shape = Box{};
    sample.pose.position = position;
    sample.mass = 12.0f;
    sample.inertia = {2.0f, 2.0f, 2.0f};
    return sample;
}

Quality measure(const std::vector<BodySample>& bodies) {
    std::vector<Vec3> starts;
    for (const BodySample& sample : bodies)
        starts.push_back(sample.pose.position);
    return measure_quality(bodies, starts, k_bounds);
}

class Random {
public:
    explicit Random(unsigned seed) : engine(seed) {}
    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine); }
    Vec3 vector(float reach) { return {between(-reach, reach), between(-reach, reach), between(-reach, reach)}; }
    Quat rotation() { return {between(-1, 1), between(-1, 1), between(-1, 1), between(0.1f, 1)}; }
    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec3(normal(engine), normal(engine), normal(engine)));
    }

private:
    std::mt19937 engine;
};

/// Furthest reach of a box along a direction, from its corners.
double reach(const PlacedShape& shape, const glm::dvec3& direction) {
    double furthest = -std::numeric_limits<double>::infinity();
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0})
                furthest = std::max(
                    furthest, glm::dot(direction, shape.centre + shape.axes * (shape.half * glm::dvec3(x, y, z))));
    return furthest;
}

TEST(Overlap, stacked_boxes_overlap_by_the_missing_height) {
    const PlacedShape lower = box({2, 1, 2}, {});
    EXPECT_NEAR(penetration_depth(lower, box({1, 1, 1}, {0.3f, 0.875f, 0.1f})), 0.125, 1e-12);
    EXPECT_LE(penetration_depth(lower, box({1, 1, 1}, {0.3f, 1.0f, 0.1f})), 0.0);
    EXPECT_LT(penetration_depth(lower, box({1, 1, 1}, {0.3f, 1.25f, 0.1f})), 0.0);
}

TEST(Overlap, a_box_on_its_edge_reaches_down_by_half_a_diagonal) {
    const float height = 0.5f + 0.5f * std::sqrt(2.0f) - 0.01f;
    const PlacedShape tilted = box({1, 1, 1}, {0, height, 0}, rotation_about_z(0.78539816f));
    EXPECT_NEAR(penetration_depth(box({4, 1, 4}, {}), tilted), 0.01, 1e-6);
}

TEST(Overlap, two_crossing_edges_are_measured_along_their_common_normal) {
    const Quat edge_down = rotation_about_z(0.78539816f);
    const float s = std::sin(0.78539816f / 2), c = std::cos(0.78539816f / 2);
    const PlacedShape lower = box({1, 1, 4}, {}, edge_down); // its edge runs along z
    const PlacedShape upper = box({4, 1, 1}, {0, std::sqrt(2.0f) - 0.02f, 0}, Quat{s, 0, 0, c}); // and its along x
    EXPECT_NEAR(penetration_depth(lower, upper), 0.02, 1e-6);
}

TEST(Overlap, spheres_and_boxes) {
    const PlacedShape cube = box({2, 2, 2}, {});
    EXPECT_NEAR(penetration_depth(sphere(1, {}), sphere(0.5f, {1.25f, 0, 0})), 0.25, 1e-12);
    EXPECT_NEAR(penetration_depth(cube, sphere(0.5f, {1.25f, 0.3f, 0})), 0.25, 1e-12);
    EXPECT_NEAR(penetration_depth(sphere(0.5f, {1.3f, 1.4f, 0}), cube), 0.0, 1e-6); // at an edge, 3-4-5
    EXPECT_NEAR(penetration_depth(sphere(0.5f, {0.75f, 0, 0}), cube), 0.75, 1e-12); // its centre inside
}

TEST(Overlap, depth_is_the_least_overlap_over_all_directions) {
    Random random(7);
    int overlapping = 0;
    for (int round = 0; round < 200; ++round) {
        const PlacedShape a =
            box({random.between(0.2f, 2), random.between(0.2f, 2), random.between(0.2f, 2)}, {}, random.rotation());
        const PlacedShape b = box({random.between(0.2f, 2), random.between(0.2f, 2), random.between(0.2f, 2)},
                                  random.vector(1.0f), random.rotation());
        const double depth = penetration_depth(a, b);
        EXPECT_NEAR(penetration_depth(b, a), depth, 1e-12);
        if (depth <= 0.0) continue;
        ++overlapping;
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 5000; ++i) {
            const glm::dvec3 direction = random.direction();
            least = std::min(least, reach(a, direction) + reach(b, -direction));
        }
        EXPECT_GE(least, depth - 1e-9) << "round " << round;
        EXPECT_LE(least, depth + 0.1) << "round " << round; // 5,000 directions come within about 3 degrees
    }
    EXPECT_GT(overlapping, 50);
}

TEST(CandidatePairs, are_those_that_trying_all_of_them_finds) {
    Random random(11);
    for (const std::size_t count : {0u, 1u, 2u, 5u, 64u, 700u}) {
        std::vector<Region> regions;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 p = random.vector(10.0f);
            const glm::dvec3 lower(p.x, p.y, p.z);
            regions.push_back({lower, lower + glm::dvec3(random.between(0, i % 50 == 0 ? 20.0f : 1.5f))});
        }
        std::set<std::pair<std::uint32_t, std::uint32_t>> expected, found;
        for (std::uint32_t i = 0; i < count; ++i)
            for (std::uint32_t j = i + 1; j < count; ++j)
                if (glm::all(glm::lessThanEqual(regions[i].lower, regions[j].upper)) &&
                    glm::all(glm::lessThanEqual(regions[j].lower, regions[i].upper)))
                    expected.insert({i, j});
        for_each_overlap(regions, [&](std::uint32_t a, std::uint32_t b) {
            EXPECT_TRUE(found.insert({a, b}).second) << "twice: " << a << ", " << b;
        });
        EXPECT_EQ(found, expected) << count << " regions";
    }
}

TEST(Quality, penetration_needs_a_dynamic_body) {
    const Quality fixed = measure({body({}, BodyKind::Static), body({0.5f, 0, 0}, BodyKind::Kinematic)});
    EXPECT_EQ(fixed.overlapping_pairs, 0u);
    EXPECT_EQ(fixed.max_penetration, 0.0);
    const Quality stack =
        measure({body({}, BodyKind::Static), body({0, 0.75f, 0}), body({0, 1.625f, 0}), body({9, 9, 9})});
    EXPECT_EQ(stack.overlapping_pairs, 2u);
    EXPECT_NEAR(stack.max_penetration, 0.25, 1e-12);
    EXPECT_NEAR(stack.mean_penetration, 0.1875, 1e-12);
}

TEST(Quality, what_lies_in_a_sensor_does_not_overlap) {
    BodySample sensor = body({0, 0, 0}, BodyKind::Static);
    sensor.sensor = true;
    EXPECT_EQ(measure({sensor, body({0, 0.5f, 0})}).overlapping_pairs, 0u);
}

TEST(Quality, energy_and_momenta_of_a_turned_spinning_body) {
    BodySample sample = body({1, 2, 3});
    sample.velocity = {{2, 0, 0}, {0, 5, 0}};
    sample.inertia = {1, 2, 4};
    sample.pose.rotation = rotation_about_z(1.57079633f); // its x axis points along the world's y
    BodySample ground = body({0, -9, 0}, BodyKind::Static);
    ground.mass = std::numeric_limits<float>::infinity();
    const Quality quality = measure({sample, ground});
    EXPECT_NEAR(quality.kinetic_energy, 0.5 * 12 * 4 + 0.5 * 1 * 25, 1e-4);
    EXPECT_NEAR(quality.max_speed, 2.0, 1e-12);
    EXPECT_NEAR(quality.linear_momentum[0], 24.0, 1e-9);
    EXPECT_NEAR(quality.angular_momentum[0], 0.0, 1e-4);
    EXPECT_NEAR(quality.angular_momentum[1], 3 * 24.0 + 1 * 5, 1e-4);
    EXPECT_NEAR(quality.angular_momentum[2], -2 * 24.0, 1e-4);
}

TEST(Quality, drift_and_escape_are_of_dynamic_bodies) {
    const std::vector<BodySample> bodies{body({3, 12, 4}), body({101, 0, 0}), body({500, 0, 0}, BodyKind::Kinematic)};
    const std::vector<Vec3> starts{{0, 0, 0}, {101, 0, 0}, {0, 0, 0}};
    const Quality quality = measure_quality(bodies, starts, k_bounds);
    EXPECT_NEAR(quality.max_drift, 13.0, 1e-12);
    EXPECT_NEAR(quality.max_drift_sideways, 5.0, 1e-12);
    EXPECT_EQ(quality.escaped_bodies, 1u);
    EXPECT_THROW(measure_quality(bodies, std::vector<Vec3>(2), k_bounds), Error);
}

TEST(Quality, a_non_finite_body_is_counted_and_spoils_nothing) {
    std::vector<BodySample> bodies{body({}), body({0, 0.75f, 0}), body({})};
    bodies[2].velocity.angular.y = std::numeric_limits<float>::quiet_NaN();
    const Quality quality = measure(bodies);
    EXPECT_EQ(quality.nonfinite_bodies, 1u);
    EXPECT_EQ(quality.overlapping_pairs, 1u);
    EXPECT_TRUE(std::isfinite(quality.kinetic_energy));
    EXPECT_TRUE(std::isfinite(quality.angular_momentum[1]));
}

TEST(Statistics, of_a_hundred_numbers) {
    std::vector<double> samples;
    for (int i = 100; i >= 1; --i)
        samples.push_back(i);
    const Statistics statistics = statistics_of(samples);
    EXPECT_DOUBLE_EQ(statistics.median, 50.5);
    EXPECT_DOUBLE_EQ(statistics.mean, 50.5);
    EXPECT_DOUBLE_EQ(statistics.p95, 95.0);
    EXPECT_DOUBLE_EQ(statistics.max, 100.0);
    EXPECT_DOUBLE_EQ(statistics_of({3.0}).p95, 3.0);
    EXPECT_DOUBLE_EQ(statistics_of({}).max, 0.0);
}

} // namespace
} // namespace talus::cli
