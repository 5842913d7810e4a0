// SPDX-License-Identifier: MIT
// The narrow phase's geometry, against oracles in double precision that share no code with it: a separating axis test,
// alternating projections, and points thrown at random.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "state/formulas.h"

namespace talus::engine {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr float k_margin = 0.012f; // m, how far ahead contacts are seen

/// A box for the oracles.
struct Solid {
    dvec3 centre;
    dmat3 axes; // columns
    dvec3 half;

    dvec3 local(dvec3 p) const { return glm::transpose(axes) * (p - centre); }
    dvec3 nearest(dvec3 p) const { return centre + axes * glm::clamp(local(p), -half, half); }
    /// Distance to the surface, negative inside.
    double depth(dvec3 p) const {
        const dvec3 q = glm::abs(local(p)) - half;
        return glm::length(glm::max(q, dvec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
    }
    double reach(dvec3 direction) const { return glm::dot(glm::abs(glm::transpose(axes) * direction), half); }
};

struct Separation {
    double faces = -1e30; // the largest over the six face axes
    double edges = -1e30; // over the nine cross products
    double all() const { return std::max(faces, edges); }
};

Separation separation_of(const Solid& a, const Solid& b) {
    Separation result;
    const auto along = [&](dvec3 d) { return std::abs(glm::dot(b.centre - a.centre, d)) - a.reach(d) - b.reach(d); };
    for (int i = 0; i < 3; ++i) {
        result.faces = std::max({result.faces, along(a.axes[i]), along(b.axes[i])});
        for (int k = 0; k < 3; ++k) {
            const dvec3 across = glm::cross(a.axes[i], b.axes[k]);
            if (glm::length(across) > 1e-6) result.edges = std::max(result.edges, along(glm::normalize(across)));
        }
    }
    return result;
}

/// Two boxes near each other, for the engine and for the oracles.
struct Sample {
    BodyPose pose_a{}, pose_b{};
    BodyShape shape_a{}, shape_b{};

    BoxPair pair() const {
        return {rotation_axes(pose_a.rotation), rotation_axes(pose_b.rotation), shape_a.half_extents,
                shape_b.half_extents, pose_b.position - pose_a.position};
    }
    /// Both with A's centre as the origin, as the engine's points are.
    Solid a() const { return solid(dvec3(0.0), pose_a.rotation, shape_a.half_extents); }
    Solid b() const { return solid(dvec3(pose_b.position - pose_a.position), pose_b.rotation, shape_b.half_extents); }

    ContactGeometry collide(float margin = k_margin) const {
        return collide_shapes(pose_a, shape_a, pose_b, shape_b, no_carriers(), margin);
    }
    ContactGeometry collide_swapped() const {
        return collide_shapes(pose_b, shape_b, pose_a, shape_a, no_carriers(), k_margin);
    }
    /// Cross products of nearly parallel edges are left out by the engine.
    bool has_parallel_edges() const {
        for (int i = 0; i < 9; ++i)
            if (glm::length(glm::cross(a().axes[i / 3], b().axes[i % 3])) < 0.05) return true;
        return false;
    }

private:
    static Solid solid(dvec3 centre, vec4 q, vec3 half) {
        return {centre, glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z))), dvec3(half)};
    }
};

class Samples {
public:
    float number(float lower, float upper) { return std::uniform_real_distribution<float>(lower, upper)(random); }
    vec4 rotation() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec4(normal(random), normal(random), normal(random), normal(random)));
    }
    vec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(dvec3(normal(random), normal(random), normal(random)));
    }

    /// Two boxes with a separation along their best axis of `lower` to `upper` (m).
    Sample boxes(double lower, double upper) {
        for (;;) {
            Sample sample;
            sample.shape_a = {vec3(number(0.2f, 1.0f), number(0.2f, 1.0f), number(0.2f, 1.0f)), k_shape_box};
            sample.shape_b = {vec3(number(0.2f, 1.0f), number(0.2f, 1.0f), number(0.2f, 1.0f)), k_shape_box};
            sample.pose_a.position = vec3(number(-5.0f, 5.0f), number(-5.0f, 5.0f), number(-5.0f, 5.0f));
            sample.pose_a.rotation = rotation();
            sample.pose_b.rotation = rotation();
            const vec3 direction_to_b = direction();
            // Bisection for a distance at which the separation is what is wanted.
            const double wanted = number(static_cast<float>(lower), static_cast<float>(upper));
            double near = 0.0, far = 5.0;
            for (int i = 0; i < 40; ++i) {
                const double middle = 0.5 * (near + far);
                sample.pose_b.position = sample.pose_a.position + direction_to_b * static_cast<float>(middle);
                (separation_of(sample.a(), sample.b()).all() < wanted ? near : far) = middle;
            }
            const double reached = separation_of(sample.a(), sample.b()).all();
            if (reached > lower && reached < upper && !sample.has_parallel_edges()) return sample;
        }
    }

    std::mt19937 random{2024};
};

vec4 turned(vec3 axis, float angle) {
    const float s = std::sin(0.5f * angle);
    return {axis.x * s, axis.y * s, axis.z * s, std::cos(0.5f * angle)};
}

Sample aligned_boxes(vec3 half_a, vec3 half_b, vec3 offset) {
    Sample sample;
    sample.shape_a = {half_a, k_shape_box};
    sample.shape_b = {half_b, k_shape_box};
    sample.pose_a.rotation = sample.pose_b.rotation = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    sample.pose_b.position = offset;
    return sample;
}

float deepest(const ContactGeometry& g) {
    return *std::min_element(g.separations, g.separations + g.count);
}

// ---- boxes: axes ----

TEST(BoxBox, separation_is_that_of_an_independent_axis_test) {
    Samples samples;
    for (int i = 0; i < 5'000; ++i) {
        const Sample sample = samples.boxes(-0.3, 0.3);
        const Separation expected = separation_of(sample.a(), sample.b());
        const AxisQuery query = query_axes(sample.pair(), k_axis_none);
        // A face is preferred to an edge contact which is less than k_face_preference better.
        const bool face_wins = expected.faces + k_face_preference >= expected.edges;
        const bool tie = std::abs(expected.faces + k_face_preference - expected.edges) < 1e-5;
        if (tie) continue;
        ASSERT_EQ(query.axis < 6, face_wins) << i;
        ASSERT_NEAR(query.separation, face_wins ? expected.faces : expected.edges, 5e-6) << i;
        if (expected.all() < -1e-5) {
            ASSERT_GT(sample.collide().count, 0u) << i;
        }
        if (query.separation > k_margin + 1e-5f) {
            ASSERT_EQ(sample.collide().count, 0u) << i;
        }
    }
}

TEST(BoxBox, boxes_are_apart_where_alternating_projections_say_so) {
    Samples samples;
    for (int i = 0; i < 500; ++i) {
        const Sample sample = samples.boxes(-0.05, 0.05);
        const Solid a = sample.a(), b = sample.b();
        dvec3 on_a = a.centre, on_b = b.centre;
        for (int round = 0; round < 3'000; ++round) {
            on_b = b.nearest(on_a);
            on_a = a.nearest(on_b);
        }
        const double distance = glm::length(on_b - on_a);
        const AxisQuery query = query_axes(sample.pair(), k_axis_none);
        ASSERT_LE(query.separation, distance + 1e-4) << i;
        if (distance > 1e-3 && query.axis >= 6) {
            ASSERT_GT(query.separation, 0.0f) << i;
        }
        if (distance > 1e-3 + k_face_preference) {
            ASSERT_GT(query.separation, -k_face_preference) << i;
        }
        if (query.separation > 1e-4f) {
            ASSERT_GT(distance, 0.0) << i;
        }
    }
}

TEST(BoxBox, boxes_that_share_a_random_point_are_in_contact) {
    Samples samples;
    int shared = 0;
    for (int i = 0; i < 1'000; ++i) {
        const Sample sample = samples.boxes(-0.2, 0.2);
        const Solid a = sample.a(), b = sample.b();
        bool overlap = false;
        for (int k = 0; k < 300 && !overlap; ++k) {
            const dvec3 in_box(samples.number(-1.0f, 1.0f), samples.number(-1.0f, 1.0f), samples.number(-1.0f, 1.0f));
            overlap = b.depth(a.centre + a.axes * (in_box * a.half)) < 0.0;
        }
        shared += overlap ? 1 : 0;
        if (overlap) {
            ASSERT_GT(sample.collide(0.0f).count, 0u) << i;
        }
    }
    EXPECT_GT(shared, 100) << "the samples must say something";
}

// ---- boxes: points ----

TEST(BoxBox, each_point_lies_midway_between_the_two_surfaces) {
    Samples samples;
    for (int i = 0; i < 5'000; ++i) {
        const Sample sample = samples.boxes(-0.1, 0.015);
        const Solid a = sample.a(), b = sample.b();
        const ContactGeometry g = sample.collide();
        const bool overlap = separation_of(a, b).all() < 0.0;
        if (overlap) {
            ASSERT_GE(g.count, 1u) << i;
        }
        if (g.count == 0) continue;
        ASSERT_LE(g.count, 4u);
        ASSERT_NEAR(glm::length(g.normal), 1.0f, 1e-5f);
        ASSERT_GT(glm::dot(dvec3(g.normal), b.centre), 0.0) << "the normal leads from A to B";
        // Of boxes that are apart, the two edges of the best axis need not be those which are nearest to each other.
        if (g.axis >= 6 && !overlap) continue;
        for (uint k = 0; k < g.count; ++k) {
            const dvec3 half_way = 0.5 * static_cast<double>(g.separations[k]) * dvec3(g.normal);
            ASSERT_NEAR(a.depth(dvec3(g.points[k]) - half_way), 0.0, 1e-4) << i << " axis " << g.axis;
            ASSERT_NEAR(b.depth(dvec3(g.points[k]) + half_way), 0.0, 1e-4) << i << " axis " << g.axis;
            ASSERT_LE(g.separations[k], k_margin);
        }
    }
}

// What a search of all sees of two bodies that move, beyond what contacts reach when they begin.
TEST(BoxBox, contacts_reach_no_farther_than_a_search) {
    EXPECT_GT(2.0f * k_least_skin, k_axis_persistence + k_parting);
}

TEST(BoxBox, the_same_contact_is_found_from_both_sides) {
    Samples samples;
    for (int i = 0; i < 5'000; ++i) {
        const Sample sample = samples.boxes(-0.1, 0.015);
        const ContactGeometry g = sample.collide(), mirrored = sample.collide_swapped();
        const uint axis = g.axis < 6 ? (g.axis + 3) % 6 : 6 + 3 * ((g.axis - 6) % 3) + (g.axis - 6) / 3;
        if (mirrored.axis != axis) { // two axes may tie to a rounding
            const AxisQuery query = query_axes(sample.pair(), k_axis_none);
            const AxisQuery other =
                query_axes(sample.pair(), mirrored.axis < 6 ? (mirrored.axis + 3) % 6 : k_axis_none);
            ASSERT_NEAR(query.score, other.score, k_axis_persistence + 1e-5f) << i;
            continue;
        }
        ASSERT_EQ(g.count, mirrored.count) << i;
        ASSERT_LT(glm::length(g.normal + mirrored.normal), 1e-5f) << i;
        const vec3 offset = sample.pose_b.position - sample.pose_a.position;
        for (uint k = 0; k < g.count; ++k) {
            float nearest = 1e30f, separation = 0.0f;
            for (uint m = 0; m < mirrored.count; ++m) {
                const float distance = glm::length(mirrored.points[m] + offset - g.points[k]);
                if (distance < nearest) separation = mirrored.separations[m];
                nearest = std::min(nearest, distance);
            }
            ASSERT_LT(nearest, 1e-4f) << i;
            ASSERT_NEAR(separation, g.separations[k], 1e-4f) << i;
        }
    }
}

TEST(BoxBox, the_deepest_point_of_a_face_contact_is_kept) {
    Samples samples;
    for (int i = 0; i < 300; ++i) {
        const Sample sample = samples.boxes(-0.1, 0.01);
        const ContactGeometry g = sample.collide();
        if (g.axis >= 6) continue;
        const bool a_is_reference = g.axis < 3;
        const Solid reference = a_is_reference ? sample.a() : sample.b();
        const Solid other = a_is_reference ? sample.b() : sample.a();
        const int axis = static_cast<int>(g.axis % 3);
        const dvec3 outward = dvec3(g.normal) * (a_is_reference ? 1.0 : -1.0);
        // Points all over the other box's surface, those over the reference face: none is deeper.
        for (int k = 0; k < 5'000; ++k) {
            dvec3 local(samples.number(-1.0f, 1.0f), samples.number(-1.0f, 1.0f), samples.number(-1.0f, 1.0f));
            const int face = k % 3;
            local[face] = local[face] < 0.0 ? -1.0 : 1.0;
            const dvec3 point = other.centre + other.axes * (local * other.half);
            dvec3 seen = glm::abs(reference.local(point)) - reference.half;
            seen[axis] = -1.0;
            if (std::max({seen.x, seen.y, seen.z}) > 0.0) continue;
            const double height = glm::dot(point - reference.centre, outward) - reference.half[axis];
            ASSERT_GT(height, deepest(g) - k_depth_tie - 1e-5) << i;
        }
    }
}

TEST(BoxBox, reduction_keeps_the_deepest_of_any_polygon_and_no_more_than_four) {
    Samples samples;
    for (int i = 0; i < 20'000; ++i) {
        Polygon polygon{};
        polygon.count = 5 + static_cast<uint>(i % 4);
        float lowest = 1e30f;
        for (uint k = 0; k < polygon.count; ++k) {
            const float angle =
                2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(polygon.count);
            const float z = samples.number(-0.01f, 0.01f);
            polygon.corners[k].position = vec3(std::cos(angle), samples.number(0.5f, 1.0f) * std::sin(angle), z);
            lowest = std::min(lowest, z);
        }
        const uint kept = reduce_points(polygon, no_carriers());
        ASSERT_LE(std::popcount(kept), 4);
        ASSERT_GE(std::popcount(kept), 3);
        float lowest_kept = 1e30f;
        for (uint k = 0; k < polygon.count; ++k)
            if ((kept >> k & 1u) != 0) lowest_kept = std::min(lowest_kept, polygon.corners[k].position.z);
        ASSERT_LE(lowest_kept, lowest + k_depth_tie);
    }
}

/// A regular polygon, all of it at one height.
Polygon flat_polygon(uint count) {
    Polygon polygon{};
    polygon.count = count;
    for (uint k = 0; k < count; ++k) {
        const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(count);
        polygon.corners[k] = {vec3(std::cos(angle), std::sin(angle), 0.0f), k};
    }
    return polygon;
}

TEST(BoxBox, reduction_prefers_what_touches_to_what_is_above) {
    for (uint count = 5; count <= 8; ++count) {
        for (uint k = 0; k < count; ++k) {
            Polygon polygon = flat_polygon(count);
            const uint next = (k + 1) % count;
            for (uint i = 0; i < count; ++i)
                polygon.corners[i].position.z = i == k || i == next ? -1e-4f : 2.0f * k_near;
            const uint edge = 1u << k | 1u << next;
            EXPECT_EQ(reduce_points(polygon, no_carriers()) & edge, edge) << count << ", " << k;
        }
    }
}

TEST(BoxBox, reduction_keeps_the_two_that_carried_the_load) {
    for (uint count = 5; count <= 8; ++count) {
        for (uint k = 0; k < count; ++k) {
            const Polygon polygon = flat_polygon(count);
            const uint next = (k + 1) % count;
            Carriers carriers = no_carriers();
            carriers.features[0] = feature_of(polygon, k);
            carriers.features[3] = feature_of(polygon, next);
            const uint edge = 1u << k | 1u << next;
            const uint kept = reduce_points(polygon, carriers);
            EXPECT_EQ(kept & edge, edge) << count << ", " << k;
            EXPECT_EQ(std::popcount(kept), 4) << count << ", " << k;
        }
    }
}

TEST(BoxBox, a_box_on_a_larger_one_touches_at_its_four_corners) {
    const Sample sample = aligned_boxes(vec3(2.0f, 0.5f, 2.0f), vec3(0.5f), vec3(0.3f, 0.99f, -0.2f));
    const ContactGeometry g = sample.collide();
    ASSERT_EQ(g.count, 4u);
    EXPECT_EQ(g.normal, vec3(0.0f, 1.0f, 0.0f));
    std::set<std::pair<int, int>> corners;
    for (uint k = 0; k < 4; ++k) {
        EXPECT_NEAR(g.separations[k], -0.01f, 1e-6f);
        EXPECT_NEAR(g.points[k].y, 0.495f, 1e-6f);
        EXPECT_NEAR(std::abs(g.points[k].x - 0.3f), 0.5f, 1e-6f);
        EXPECT_NEAR(std::abs(g.points[k].z + 0.2f), 0.5f, 1e-6f);
        corners.insert({g.points[k].x > 0.3f, g.points[k].z > -0.2f});
    }
    EXPECT_EQ(corners.size(), 4u);
}

/// The normal of two edges separates them most, as B reaches over A's edge, but a single point would jump from one side
/// to the other as B rocks.
TEST(BoxBox, an_edge_that_lies_on_a_face_touches_it_at_both_ends) {
    for (const float tilt : {-0.014f, 0.014f}) {
        Sample sample;
        sample.shape_a = {vec3(0.5f, 0.5f, 0.5f), k_shape_box};
        sample.shape_b = {vec3(0.8f, 0.3f, 0.3f), k_shape_box};
        const glm::dquat on_edge = glm::angleAxis(0.25 * std::numbers::pi, dvec3(1, 0, 0));
        const glm::dquat q = glm::angleAxis(static_cast<double>(tilt), dvec3(0, 0, 1)) * on_edge;
        sample.pose_a.rotation = vec4(0, 0, 0, 1);
        sample.pose_b.rotation = vec4(glm::vec4(q.x, q.y, q.z, q.w));
        sample.pose_b.position = vec3(0.0f, 0.5f + 0.3f * std::sqrt(2.0f) - 0.02f, 0.0f);
        ASSERT_GE(query_axes(sample.pair(), k_axis_none).axis, 6u) << "edges win";
        const ContactGeometry g = sample.collide();
        ASSERT_EQ(g.count, 2u);
        EXPECT_EQ(g.axis, 1u);
        EXPECT_NEAR(std::abs(g.points[0].x - g.points[1].x), 1.0f, 1e-3f);
        EXPECT_NEAR(g.separations[0] + g.separations[1], -0.04f, 1e-3f);
    }
}

TEST(BoxBox, crossed_edges_touch_at_one_point) {
    constexpr float quarter = std::numbers::pi_v<float> / 4.0f, root = std::numbers::sqrt2_v<float>;
    Sample sample =
        aligned_boxes(vec3(0.5f, 0.5f, 2.0f), vec3(2.0f, 0.4f, 0.4f), vec3(0.3f, 0.9f * root - 0.01f, -0.4f));
    sample.pose_a.rotation = turned({0, 0, 1}, quarter); // an edge along z on top
    sample.pose_b.rotation = turned({1, 0, 0}, quarter); // an edge along x below
    const ContactGeometry g = sample.collide();
    ASSERT_EQ(g.count, 1u);
    EXPECT_GE(g.axis, 6u);
    EXPECT_LT(glm::length(g.normal - vec3(0.0f, 1.0f, 0.0f)), 1e-5f);
    EXPECT_NEAR(g.separations[0], -0.01f, 1e-5f);
    // Midway between the two edges, where they cross seen from above: x of A's edge, z of B's.
    EXPECT_LT(glm::length(g.points[0] - vec3(0.0f, 0.5f * root - 0.005f, -0.4f)), 1e-5f);
}

// ---- boxes: what stays the same from step to step ----

TEST(BoxBox, a_resting_box_keeps_its_axis_while_it_wobbles) {
    Samples samples;
    Carriers carriers = no_carriers();
    int flips = 0, flips_without_memory = 0;
    uint last_free_axis = k_axis_none;
    for (int i = 0; i < 1'000; ++i) {
        Sample sample = aligned_boxes(vec3(0.5f), vec3(0.5f), vec3(0.0f, 0.999f + samples.number(-3e-4f, 3e-4f), 0.0f));
        sample.pose_b.rotation = turned(samples.direction(), samples.number(0.0f, 5e-4f));
        const ContactGeometry g =
            collide_shapes(sample.pose_a, sample.shape_a, sample.pose_b, sample.shape_b, carriers, k_margin);
        ASSERT_EQ(g.count, 4u);
        flips += carriers.axis != k_axis_none && g.axis != carriers.axis ? 1 : 0;
        carriers.axis = g.axis;
        const uint free_axis = sample.collide().axis;
        flips_without_memory += last_free_axis != k_axis_none && free_axis != last_free_axis ? 1 : 0;
        last_free_axis = free_axis;
    }
    EXPECT_EQ(flips, 0);
    EXPECT_GT(flips_without_memory, 10) << "the wobble must be one that would flip the axis";
}

TEST(BoxBox, features_keep_their_names_under_small_motion) {
    Sample sample = aligned_boxes(vec3(2.0f, 0.5f, 2.0f), vec3(0.3f), vec3(0.5f, 0.799f, 0.4f));
    std::array<uint, 4> first{};
    for (int i = 0; i < 200; ++i) {
        const float t = static_cast<float>(i);
        sample.pose_b.position = vec3(0.5f + 1e-3f * t, 0.799f, 0.4f - 1e-3f * t);
        sample.pose_b.rotation = turned({0, 1, 0}, 0.3f + 1e-3f * t);
        const ContactGeometry g = sample.collide();
        ASSERT_EQ(g.count, 4u);
        std::array<uint, 4> features{};
        std::copy_n(g.features, 4, features.begin());
        if (i == 0) first = features;
        ASSERT_EQ(features, first) << i;
    }
    EXPECT_EQ(std::set<uint>(first.begin(), first.end()).size(), 4u) << "each point has a name of its own";

    // The corners of another face are other features.
    sample.pose_b.rotation = turned({1, 0, 0}, 0.5f * std::numbers::pi_v<float>);
    const ContactGeometry rolled = sample.collide();
    ASSERT_EQ(rolled.count, 4u);
    for (uint k = 0; k < 4; ++k)
        EXPECT_EQ(std::ranges::count(first, rolled.features[k]), 0) << k;
}

// ---- spheres ----

TEST(BoxSphere, contacts_have_closed_forms_at_a_face_an_edge_and_a_corner) {
    const Axes axes = rotation_axes(vec4(0.0f, 0.0f, 0.0f, 1.0f));
    const vec3 half(1.0f, 0.5f, 0.25f);
    struct Case {
        vec3 centre, normal;
        float separation;
    };
    const float r2 = std::numbers::sqrt2_v<float>, r3 = std::numbers::sqrt3_v<float>;
    for (const Case& c : {
             Case{{0.3f, 0.9f, 0.1f}, {0, 1, 0}, 0.4f - 0.5f},
             Case{{-1.4f, 0.2f, 0.1f}, {-1, 0, 0}, 0.4f - 0.5f},
             Case{{1.3f, 0.8f, 0.0f}, {1 / r2, 1 / r2, 0}, 0.3f * r2 - 0.5f},
             Case{{1.2f, -0.7f, 0.45f}, {1 / r3, -1 / r3, 1 / r3}, 0.2f * r3 - 0.5f},
             Case{{0.1f, 0.45f, 0.0f}, {0, 1, 0}, -0.05f - 0.5f}, // centre inside, nearest to the top
             Case{{0.1f, 0.0f, -0.24f}, {0, 0, -1}, -0.01f - 0.5f},
         }) {
        const ContactGeometry g = collide_box_sphere(axes, half, 0.5f, c.centre, k_margin);
        ASSERT_EQ(g.count, 1u);
        EXPECT_LT(glm::length(g.normal - c.normal), 1e-5f);
        EXPECT_NEAR(g.separations[0], c.separation, 1e-5f);
        const vec3 on_sphere = c.centre - c.normal * 0.5f;
        EXPECT_LT(glm::length(g.points[0] - (on_sphere - c.normal * (0.5f * c.separation))), 1e-5f);
    }
    EXPECT_EQ(collide_box_sphere(axes, half, 0.5f, vec3(0.0f, 1.03f, 0.0f), k_margin).count, 0u);
}

TEST(BoxSphere, the_order_of_the_bodies_mirrors_the_contact) {
    Samples samples;
    for (int i = 0; i < 1'000; ++i) {
        Sample sample = samples.boxes(-0.1, 0.0);
        sample.shape_b = {vec3(samples.number(0.2f, 1.0f)), k_shape_sphere};
        const Solid box = sample.a();
        const dvec3 centre = sample.b().centre;
        const ContactGeometry g = sample.collide(), mirrored = sample.collide_swapped();
        ASSERT_EQ(g.count, mirrored.count);
        const double expected = box.depth(centre) - static_cast<double>(sample.shape_b.half_extents.x);
        if (std::abs(expected - static_cast<double>(k_margin)) > 1e-5) {
            ASSERT_EQ(g.count == 1, expected < static_cast<double>(k_margin));
        }
        if (g.count == 0) continue;
        ASSERT_NEAR(g.separations[0], expected, 1e-5);
        ASSERT_EQ(g.normal, -mirrored.normal);
        ASSERT_LT(glm::length(mirrored.points[0] + vec3(centre) - g.points[0]), 1e-5f);
    }
}

TEST(SphereSphere, contacts_have_closed_forms) {
    Samples samples;
    for (int i = 0; i < 1'000; ++i) {
        const vec3 direction = samples.direction();
        const float radius_a = samples.number(0.1f, 2.0f), radius_b = samples.number(0.1f, 2.0f);
        const float separation = samples.number(-0.09f, 0.04f);
        const vec3 offset = direction * (radius_a + radius_b + separation);
        const ContactGeometry g = collide_spheres(radius_a, radius_b, offset, k_margin);
        if (std::abs(separation - k_margin) > 1e-5f) {
            ASSERT_EQ(g.count, separation < k_margin ? 1u : 0u);
        }
        if (g.count == 0) continue;
        ASSERT_LT(glm::length(g.normal - direction), 1e-5f);
        ASSERT_NEAR(g.separations[0], separation, 3e-6f);
        ASSERT_LT(glm::length(g.points[0] - direction * (radius_a + 0.5f * separation)), 5e-6f);
    }
    const ContactGeometry same_centre = collide_spheres(1.0f, 2.0f, vec3(0.0f), k_margin);
    EXPECT_EQ(same_centre.normal, vec3(0.0f, 1.0f, 0.0f));
    EXPECT_FLOAT_EQ(same_centre.separations[0], -3.0f);
}

} // namespace
} // namespace talus::engine
