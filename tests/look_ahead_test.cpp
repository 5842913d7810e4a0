// SPDX-License-Identifier: MIT
// Contacts between bodies that move: their geometry is that of the moment in which they meet.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "state/formulas.h"

namespace talus::engine {
namespace {

constexpr float k_margin = 0.2f; // m

BodyPose pose_at(vec3 position) {
    BodyPose pose{};
    pose.position = position;
    pose.rotation = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    return pose;
}

BodyShape box_of(vec3 half_extents) {
    return {half_extents, k_shape_box | (k_kind_rigid << 8)};
}

BodyShape sphere_of(float radius) {
    return {vec3(radius), k_shape_sphere | (k_kind_rigid << 8)};
}

TEST(LookAhead, what_does_not_move_is_seen_as_it_is) {
    const BodyShape box = box_of(vec3(0.5f));
    for (const float gap : {-0.1f, -0.001f, 0.0f, 0.05f}) {
        const BodyPose a = pose_at(vec3(0.0f)), b = pose_at(vec3(0.2f, 1.0f + gap, 0.0f));
        const ContactGeometry still = collide_shapes(a, box, b, box, no_carriers(), k_margin);
        for (const vec3 motion : {vec3(0.0f), vec3(0.0f, 0.1f, 0.0f)}) { // at rest, and going apart
            const ContactGeometry g = collide_moving_shapes(a, box, b, box, motion, no_carriers(), k_margin);
            ASSERT_EQ(g.count, 4u) << gap;
            EXPECT_EQ(g.shift, vec3(0.0f));
            for (uint i = 0; i < 4; ++i) {
                EXPECT_EQ(g.points[i], still.points[i]);
                EXPECT_EQ(g.separations[i], still.separations[i]);
            }
        }
    }
}

TEST(LookAhead, the_next_tile_of_a_floor_bears_and_does_not_block) {
    const BodyPose tile = pose_at(vec3(1.0f, -0.5f, 0.0f)); // from x = 0.5, with its upper side at y = 0
    for (const float ahead : {0.08f, 0.01f, 0.0001f, -0.0003f}) {
        for (const float overlap : {0.0f, 0.001f, 0.004f}) {
            const vec3 motion(0.1f, 0.0f, 0.0f);
            const BodyPose box = pose_at(vec3(-ahead, 0.5f - overlap, 0.0f));
            const ContactGeometry g = collide_moving_shapes(tile, box_of(vec3(0.5f)), box, box_of(vec3(0.5f)), motion,
                                                            no_carriers(), k_margin);
            EXPECT_NEAR(g.normal.y, 1.0f, 1e-6f) << ahead << ' ' << overlap;
            EXPECT_NEAR(g.separation, -overlap, 1e-6f) << ahead << ' ' << overlap;
        }
    }
    const ContactGeometry ball =
        collide_moving_shapes(tile, box_of(vec3(0.5f)), pose_at(vec3(0.45f, 0.399f, 0.0f)), sphere_of(0.4f),
                              vec3(0.1f, 0.0f, 0.0f), no_carriers(), k_margin);
    EXPECT_NEAR(ball.normal.y, 1.0f, 1e-4f);
    EXPECT_NEAR(ball.separation, -0.001f, 1e-4f);
}

TEST(LookAhead, a_wall_blocks_and_does_not_bear) {
    const BodyPose wall = pose_at(vec3(1.0f, 0.0f, 0.0f)); // from x = 0.5
    const ContactGeometry g =
        collide_moving_shapes(wall, box_of(vec3(0.5f)), pose_at(vec3(-0.08f, 0.3f, 0.0f)), box_of(vec3(0.5f)),
                              vec3(0.1f, 0.0f, 0.0f), no_carriers(), k_margin);
    EXPECT_NEAR(g.normal.x, -1.0f, 1e-6f);
    EXPECT_NEAR(g.separation, 0.08f, 1e-6f) << "the gap of now, not that of the meeting";
    EXPECT_EQ(g.count, 4u);
}

TEST(LookAhead, what_passes_by_an_edge_is_not_caught) {
    // It rises past the upper edge of a wall by 5 cm in the moment in which it comes above it.
    const BodyPose wall = pose_at(vec3(1.0f, 0.0f, 0.0f));
    const ContactGeometry g = collide_moving_shapes(wall, box_of(vec3(0.5f)), pose_at(vec3(-0.1f, 0.95f, 0.0f)),
                                                    box_of(vec3(0.5f)), vec3(0.2f, 0.2f, 0.0f), no_carriers(), 1.0f);
    for (uint i = 0; i < g.count; ++i) {
        const float closing = -dot3(g.normal, vec3(0.2f, 0.2f, 0.0f));
        EXPECT_GE(g.separations[i], closing) << "nothing that this step's motion would run into";
    }
}

/// Of two shapes along the axis that separates them most.
float largest_separation(const BodyPose& a, const BodyShape& shape_a, const BodyPose& b, const BodyShape& shape_b) {
    if (is_sphere(shape_b)) return collide_shapes(a, shape_a, b, shape_b, no_carriers(), 1.0f).separation;
    return query_axes(make_box_pair(a, shape_a, b, shape_b), k_axis_none).separation;
}

// Along any direction two convex bodies are at most as far apart as they are at all. So a contact seen ahead is never
// farther than the nearest distance of now, and stepping to where it closes leaves no overlap beyond a graze.
TEST(LookAhead, never_lets_bodies_pass_into_each_other) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    int seen = 0;
    for (int i = 0; i < 20'000; ++i) {
        BodyPose a = pose_at(vec3(0.0f));
        BodyPose b = pose_at(1.6f * vec3(unit(random), unit(random), unit(random)));
        a.rotation = normalise_quaternion(vec4(unit(random), unit(random), unit(random), unit(random)));
        b.rotation = normalise_quaternion(vec4(unit(random), unit(random), unit(random), unit(random)));
        const BodyShape shape_a = box_of(vec3(0.4f, 0.6f, 0.5f));
        const BodyShape shape_b = i % 2 == 0 ? box_of(vec3(0.3f, 0.5f, 0.4f)) : sphere_of(0.4f);
        const vec3 motion = 0.3f * vec3(unit(random), unit(random), unit(random));
        const float apart = largest_separation(a, shape_a, b, shape_b);
        if (apart <= 0.0f || apart == k_far_apart) continue;
        const ContactGeometry g = collide_moving_shapes(a, shape_a, b, shape_b, motion, no_carriers(), 1.0f);
        if (g.separation == k_far_apart) continue;
        // 2.5 mm: an edge as the normal has to be that much better than a face. And where a face stands for edges its
        // normal may be 2 degrees from theirs.
        const float turned = 0.032f * k_steps_ahead * std::sqrt(dot3(motion, motion));
        EXPECT_LE(g.separation, apart + 2.6e-3f + (g.axis < 6u ? turned : 0.0f)) << i;
        // As far as the contact lets B come.
        const float closing = -dot3(g.normal, motion);
        const float share = closing > g.separation ? std::max(g.separation, 0.0f) / closing : 1.0f;
        b.position = b.position + motion * share;
        EXPECT_GT(largest_separation(a, shape_a, b, shape_b), -2.0f * k_graze) << i;
        ++seen;
    }
    EXPECT_GT(seen, 3'000);
}

} // namespace
} // namespace talus::engine
