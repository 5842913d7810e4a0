// SPDX-License-Identifier: MIT
// Warm start: which point of the last step a new point takes its impulses from, and how they are carried over.
#include <initializer_list>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "state/formulas.h"

namespace talus::engine {
namespace {

ContactGeometry three_points() {
    ContactGeometry g = no_contact();
    g.count = 3;
    g.points[0] = vec3(0.0f, 0.0f, 0.0f);
    g.points[1] = vec3(1.0f, 0.0f, 0.0f);
    g.points[2] = vec3(0.0f, 0.0f, 1.0f);
    for (uint i = 0; i < 3; ++i)
        g.features[i] = 10 + i;
    return g;
}

OldPoints old_points(std::initializer_list<std::pair<vec3, uint>> points) {
    OldPoints old{};
    old.axis = k_axis_none;
    for (const auto& [anchor, feature] : points) {
        old.anchors[old.count] = anchor;
        old.features[old.count++] = feature;
    }
    return old;
}

TEST(WarmStart, points_are_matched_by_feature_first) {
    // The feature counts even where another old point lies nearer.
    const OldPoints old = old_points({{vec3(0.0f), 11}, {vec3(1.0f, 0.0f, 0.0f), 10}, {vec3(5.0f), 12}});
    const PointMatch match = match_points(three_points(), old);
    EXPECT_EQ(match.old_index[0], 1u);
    EXPECT_EQ(match.old_index[1], 0u);
    EXPECT_EQ(match.old_index[2], 2u);
    EXPECT_EQ(match.old_index[3], k_none);
}

TEST(WarmStart, without_a_namesake_the_nearest_old_point_counts) {
    const OldPoints old = old_points({{vec3(0.03f, 0.0f, 0.0f), 20},
                                      {vec3(0.01f, 0.0f, 0.0f), 21},
                                      {vec3(1.0f, 0.0f, k_anchor_match + 1e-3f), 22},
                                      {vec3(0.0f, 0.0f, 1.0f + k_anchor_match - 1e-3f), 23}});
    const PointMatch match = match_points(three_points(), old);
    EXPECT_EQ(match.old_index[0], 1u) << "the nearer of two";
    EXPECT_EQ(match.old_index[1], k_none) << "too far";
    EXPECT_EQ(match.old_index[2], 3u) << "just near enough";
}

TEST(WarmStart, features_of_another_axis_mean_nothing) {
    OldPoints old = old_points({{vec3(1.0f, 0.0f, 0.0f), 10}});
    old.axis = 3;
    const PointMatch match = match_points(three_points(), old);
    EXPECT_EQ(match.old_index[0], k_none);
    EXPECT_EQ(match.old_index[1], 0u);
}

TEST(WarmStart, an_old_point_is_given_away_once) {
    ContactGeometry g = three_points();
    g.points[1] = vec3(0.01f, 0.0f, 0.0f);
    const PointMatch match = match_points(g, old_points({{vec3(0.0f), 30}}));
    EXPECT_EQ(match.old_index[0], 0u);
    EXPECT_EQ(match.old_index[1], k_none);
}

TEST(WarmStart, friction_is_carried_as_a_vector) {
    std::mt19937 random(5);
    std::normal_distribution<float> spread;
    const auto direction = [&] {
        const float x = spread(random), y = spread(random);
        return glm::normalize(vec3(x, y, spread(random)));
    };
    for (int i = 0; i < 1'000; ++i) {
        const vec3 normal = direction();
        // A normal nearly the same: its tangents may lie anywhere.
        const vec3 next = glm::normalize(normal + 1e-3f * direction());
        Manifold old{};
        old.normal = normal;
        old.twist_impulse = 3.0f;
        old.tangent_impulse_1 = spread(random);
        old.tangent_impulse_2 = spread(random);
        Manifold fresh{};
        fresh.normal = next;
        const Manifold carried = carry_over(fresh, old, Parameters{});
        const auto sideways = [](const Manifold& m) {
            const Axes frame = contact_frame(m.normal);
            return frame.x * m.tangent_impulse_1 + frame.y * m.tangent_impulse_2;
        };
        ASSERT_EQ(carried.twist_impulse, 3.0f);
        const vec3 before = sideways(old);
        ASSERT_LT(glm::length(sideways(carried) - before), 2e-3f * (1.0f + glm::length(before)));
    }
}

} // namespace
} // namespace talus::engine
