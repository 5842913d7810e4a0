// SPDX-License-Identifier: MIT
// The narrow phase's geometry, against oracles in double precision that share no code with it: a separating axis test,
// alternating projections, and points thrown at random.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "state/formulas.h"

namespace talus::engine {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr float k_margin = 0.02f; // m, how far ahead contacts are seen

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

// ---- boxes: clipping, against Sutherland and Hodgman's in double precision ----

using Outline = std::vector<dvec3>; // x and y along the reference face, z above it

/// What of a polygon has sign * p[axis] <= limit.
Outline cut(const Outline& polygon, int axis, double sign, double limit) {
    Outline result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 from = polygon[i], to = polygon[(i + 1) % polygon.size()];
        const double d_from = sign * from[axis] - limit, d_to = sign * to[axis] - limit;
        if (d_from <= 0.0) result.push_back(from);
        if ((d_from <= 0.0) != (d_to <= 0.0)) result.push_back(from + (to - from) * (d_from / (d_from - d_to)));
    }
    return result;
}

double twice_area(dvec3 a, dvec3 b, dvec3 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double area_of(const Outline& polygon) {
    double sum = 0.0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        sum += 0.5 * twice_area(polygon[0], polygon[i - 1], polygon[i]);
    return std::abs(sum);
}

double distance_to(const Outline& polygon, dvec3 p) {
    double nearest = 1e30;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 from(polygon[i]), along = glm::dvec2(polygon[(i + 1) % polygon.size()]) - from;
        const double square = glm::dot(along, along);
        const double t = square > 0.0 ? glm::clamp(glm::dot(glm::dvec2(p) - from, along) / square, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(glm::dvec2(p) - from - along * t));
    }
    return nearest;
}

/// Of points in any order, up to four.
double area_spanned_by(const Outline& p) {
    if (p.size() < 4) return area_of(p);
    return std::max({area_of(p), area_of({p[0], p[2], p[1], p[3]}), area_of({p[0], p[1], p[3], p[2]})});
}

/// The largest area that four of the polygon's points span.
double best_area(const Outline& polygon) {
    if (polygon.size() <= 4) return area_of(polygon);
    double best = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        for (std::size_t k = i + 1; k < polygon.size(); ++k)
            for (std::size_t m = k + 1; m < polygon.size(); ++m)
                for (std::size_t n = m + 1; n < polygon.size(); ++n)
                    best = std::max(best, area_of({polygon[i], polygon[k], polygon[m], polygon[n]}));
    return best;
}

/// The face contact of a sample: all that the two faces have in common, and the points that the engine kept.
struct FaceContact {
    Outline outline;
    Outline kept;

    FaceContact(const Sample& sample, const ContactGeometry& g) {
        const bool a_is_reference = g.axis < 3;
        const Solid reference = a_is_reference ? sample.a() : sample.b();
        const Solid other = a_is_reference ? sample.b() : sample.a();
        const int n = static_cast<int>(g.axis % 3), u = (n + 1) % 3, v = (n + 2) % 3;
        const dvec3 outward = dvec3(g.normal) * (a_is_reference ? 1.0 : -1.0);
        const auto seen = [&](dvec3 p) {
            const dvec3 local = reference.local(p);
            return dvec3(local[u], local[v], glm::dot(p - reference.centre, outward) - reference.half[n]);
        };
        int face = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(glm::dot(other.axes[i], outward)) > std::abs(glm::dot(other.axes[face], outward))) face = i;
        const double side = glm::dot(other.axes[face], outward) > 0.0 ? -1.0 : 1.0;
        for (const auto& [i, k] : {std::pair(1, 1), std::pair(-1, 1), std::pair(-1, -1), std::pair(1, -1)}) {
            dvec3 corner(0.0);
            corner[face] = side, corner[(face + 1) % 3] = i, corner[(face + 2) % 3] = k;
            outline.push_back(seen(other.centre + other.axes * (corner * other.half)));
        }
        for (const double sign : {1.0, -1.0}) {
            outline = cut(outline, 0, sign, reference.half[u]);
            outline = cut(outline, 1, sign, reference.half[v]);
        }
        for (uint i = 0; i < g.count; ++i) {
            const dvec3 p = seen(dvec3(g.points[i]));
            EXPECT_NEAR(p.z, 0.5 * static_cast<double>(g.separations[i]), 1e-5);
            kept.emplace_back(p.x, p.y, g.separations[i]);
        }
    }
    /// Distance of a point from the plane of the incident face, along z.
    double off_plane(dvec3 p) const {
        dvec3 normal(0.0); // Newell's, as some corners may be the same
        for (std::size_t i = 0; i < outline.size(); ++i)
            normal += glm::cross(outline[i], outline[(i + 1) % outline.size()]);
        return glm::dot(p - outline[0], normal) / normal.z;
    }
};

double lowest(const Outline& points) {
    double z = 1e30;
    for (const dvec3 p : points)
        z = std::min(z, p.z);
    return z;
}

TEST(BoxBox, the_points_of_a_face_contact_lie_on_the_outline_of_what_the_faces_have_in_common) {
    Samples samples;
    for (int i = 0; i < 20'000; ++i) {
        const Sample sample = samples.boxes(-0.05, 0.015);
        const ContactGeometry g = sample.collide();
        if (g.axis >= 6) continue;
        const FaceContact contact(sample, g);
        // There is nothing where edges touch, less deep than the face that is preferred.
        ASSERT_EQ(g.count == 0, lowest(contact.outline) > static_cast<double>(k_margin)) << i;
        if (g.count == 0) continue;
        for (const dvec3 p : contact.kept) {
            ASSERT_LT(distance_to(contact.outline, p), 1e-5) << i;
            ASSERT_NEAR(contact.off_plane(p), 0.0, 1e-5) << i;
        }
        ASSERT_LT(lowest(contact.kept), lowest(contact.outline) + static_cast<double>(k_depth_tie) + 1e-5) << i;
    }
}

TEST(BoxBox, the_points_of_boxes_that_stand_on_each_other_span_nearly_all_that_four_can) {
    Samples samples;
    std::array<int, 9> corners{};
    double worst = 1.0, sum = 0.0;
    for (int i = 0; i < 20'000; ++i) {
        Sample sample = samples.boxes(-0.05, 0.0); // for the sizes
        const vec3 half_a = sample.shape_a.half_extents, half_b = sample.shape_b.half_extents;
        const vec4 tilt = turned(samples.direction(), samples.number(0.0f, 2e-4f));
        const vec4 twist = turned({0, 1, 0}, samples.number(0.0f, 6.3f));
        const vec3 offset(samples.number(-1.0f, 1.0f) * half_a.x, half_a.y + half_b.y,
                          samples.number(-1.0f, 1.0f) * half_a.z);
        sample.pose_b.rotation = multiply_quaternions(sample.pose_a.rotation, multiply_quaternions(tilt, twist));
        sample.pose_b.position = sample.pose_a.position + rotate(sample.pose_a.rotation, offset);
        const ContactGeometry g = sample.collide();
        ASSERT_EQ(g.axis % 3, 1u) << i;
        const FaceContact contact(sample, g);
        ++corners[contact.outline.size()];
        const double share = area_spanned_by(contact.kept) / best_area(contact.outline);
        worst = std::min(worst, share), sum += share;
    }
    // One point after the other is not always the best choice of four, but never a bad one.
    EXPECT_GT(worst, 0.7);
    EXPECT_GT(sum / 20'000.0, 0.98);
    for (std::size_t count = 3; count <= 8; ++count)
        EXPECT_GT(corners[count], 50) << "the samples must have outlines of all kinds";
}

/// A sample in which box B stands on a face of A, with all sides parallel but for the last bits.
struct Aligned {
    const char* name;
    vec3 half_a, half_b; // x and y along the face, z across
    glm::vec2 offset;    // along the face
};

const Aligned k_aligned[] = {
    {"the same size", {0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {0.0f, 0.0f}},
    {"bricks that overlap by half", {0.5f, 0.25f, 0.25f}, {0.5f, 0.25f, 0.25f}, {0.5f, 0.0f}},
    {"a brick half-way over the corner of another", {0.5f, 0.25f, 0.25f}, {0.5f, 0.25f, 0.25f}, {0.5f, -0.25f}},
    {"a small box at the edge of a large one", {2.0f, 2.0f, 0.5f}, {0.3f, 0.3f, 0.3f}, {1.7f, 0.4f}},
    {"a small box in the corner of a large one", {2.0f, 2.0f, 0.5f}, {0.3f, 0.3f, 0.3f}, {1.7f, -1.7f}},
    {"a large box at the edge of a small one", {0.3f, 0.3f, 0.3f}, {2.0f, 2.0f, 0.5f}, {0.4f, 1.7f}},
    {"a plank across another", {1.0f, 0.1f, 0.1f}, {0.1f, 1.0f, 0.1f}, {0.0f, 0.0f}},
    {"a plank across the end of another", {1.0f, 0.1f, 0.1f}, {0.1f, 1.0f, 0.1f}, {0.9f, 0.9f}},
    {"a box in the middle of a large one", {2.0f, 2.0f, 0.5f}, {0.3f, 0.2f, 0.3f}, {0.1f, 0.2f}},
    {"a box in the middle below a large one", {0.3f, 0.2f, 0.3f}, {2.0f, 2.0f, 0.5f}, {0.1f, 0.2f}},
};

TEST(BoxBox, aligned_boxes_touch_at_the_corners_of_their_overlap_whatever_the_last_bit_does) {
    Samples samples;
    for (const Aligned& c : k_aligned) {
        const vec3 lower = glm::max(-c.half_a, vec3(c.offset, 0.0f) - c.half_b);
        const vec3 upper = glm::min(c.half_a, vec3(c.offset, 0.0f) + c.half_b);
        for (int i = 0; i < 6'000; ++i) {
            const int face = i % 6, n = face / 2, u = (n + 1) % 3, v = (n + 2) % 3;
            const float size = i % 5 == 0 ? 0.0f : std::pow(10.0f, samples.number(-9.0f, -4.0f));
            const bool swapped = (i / 6) % 2 == 1;
            vec3 half_a, half_b, offset;
            half_a[u] = c.half_a.x, half_a[v] = c.half_a.y, half_a[n] = c.half_a.z;
            half_b[u] = c.half_b.x, half_b[v] = c.half_b.y, half_b[n] = c.half_b.z;
            const float up = face % 2 == 0 ? 1.0f : -1.0f;
            offset[u] = c.offset.x, offset[v] = c.offset.y, offset[n] = up * (c.half_a.z + c.half_b.z);
            vec3 corners[4];
            for (int k = 0; k < 4; ++k) {
                corners[k][u] = (k & 1) != 0 ? upper.x : lower.x;
                corners[k][v] = (k & 2) != 0 ? upper.y : lower.y;
                corners[k][n] = up * c.half_a.z;
            }
            offset += samples.direction() * size;

            Sample sample = aligned_boxes(half_a, half_b, offset);
            sample.pose_b.rotation = turned(samples.direction(), size * samples.number(0.0f, 1.0f));
            if (i % 3 == 0) { // both turned, and away from the origin, for other last bits
                const vec4 q = samples.rotation();
                sample.pose_a.rotation = q;
                sample.pose_b.rotation = multiply_quaternions(q, sample.pose_b.rotation);
                sample.pose_a.position = samples.direction() * 3.0f;
                sample.pose_b.position = sample.pose_a.position + rotate(q, offset);
                for (vec3& corner : corners)
                    corner = rotate(q, corner);
            }
            if (swapped) {
                std::swap(sample.pose_a, sample.pose_b);
                std::swap(sample.shape_a, sample.shape_b);
                for (vec3& corner : corners)
                    corner += sample.pose_b.position - sample.pose_a.position;
            }
            // Each box's face in its turn is the reference.
            Carriers carriers = no_carriers();
            carriers.axis = static_cast<uint>(n + (i / 12 % 2) * 3);
            const ContactGeometry g =
                collide_shapes(sample.pose_a, sample.shape_a, sample.pose_b, sample.shape_b, carriers, k_margin);
            ASSERT_EQ(g.axis, carriers.axis) << c.name << ", " << i;
            ASSERT_EQ(g.count, 4u) << c.name << ", " << i << ", off by " << size;
            for (const vec3 corner : corners) {
                float nearest = 1e30f;
                for (const vec3 point : g.points)
                    nearest = std::min(nearest, glm::length(point - corner));
                ASSERT_LT(nearest, 1e-5f + 8.0f * size) << c.name << ", " << i << ", off by " << size;
            }
            const FaceContact contact(sample, g);
            ASSERT_GT(area_spanned_by(contact.kept),
                      (1.0 - 1e-5 - 8.0 * static_cast<double>(size)) * area_of(contact.outline));
            ASSERT_EQ(std::set<uint>(g.features, g.features + 4).size(), 4u) << "each point has a name of its own";
        }
    }
}

// ---- boxes: reduction ----

/// A regular polygon at one height, in the slots from `first_slot` on; point k's feature is k.
Candidates flat_polygon(uint count, uint first_slot = 0) {
    Candidates candidates{};
    for (uint k = 0; k < count; ++k) {
        const uint slot = (first_slot + k) % k_candidate_count;
        const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(count);
        candidates.points[slot] = vec3(std::cos(angle), std::sin(angle), 0.0f);
        candidates.features[slot] = k;
        candidates.present |= 1u << slot;
    }
    return candidates;
}

/// A bit a feature.
uint features_of(const Picks& kept) {
    uint features = 0;
    for (uint i = 0; i < kept.count; ++i)
        features |= 1u << kept.picks[i].feature;
    return features;
}

TEST(BoxBox, reduction_keeps_the_deepest_of_any_polygon_and_no_more_than_four) {
    Samples samples;
    for (uint i = 0; i < 20'000; ++i) {
        const uint count = 1 + i % 8;
        Candidates candidates = flat_polygon(count, i / 8);
        float lowest = 1e30f;
        for (uint slot = 0; slot < k_candidate_count; ++slot) {
            vec3& point = candidates.points[slot];
            point.y *= samples.number(0.5f, 1.0f);
            point.z = samples.number(-0.01f, 0.01f);
            if (is_present(candidates, slot)) lowest = std::min(lowest, point.z);
        }
        const Picks kept = reduce_points(candidates, no_carriers());
        ASSERT_EQ(kept.count, static_cast<uint>(std::popcount(features_of(kept)))) << "no point is kept twice";
        ASSERT_LE(kept.count, std::min(count, 4u));
        ASSERT_GE(kept.count, std::min(count, 3u));
        float lowest_kept = 1e30f;
        for (uint k = 0; k < kept.count; ++k)
            lowest_kept = std::min(lowest_kept, kept.picks[k].point.z);
        ASSERT_LE(lowest_kept, lowest + k_depth_tie);
    }
}

TEST(BoxBox, reduction_keeps_all_of_four_and_none_of_none) {
    for (uint count = 0; count <= 4; ++count)
        for (uint slot = 0; slot < k_candidate_count; ++slot)
            EXPECT_EQ(features_of(reduce_points(flat_polygon(count, slot), no_carriers())), (1u << count) - 1u);
}

TEST(BoxBox, reduction_prefers_what_touches_to_what_is_above) {
    for (uint count = 5; count <= 8; ++count) {
        for (uint k = 0; k < count; ++k) {
            Candidates candidates = flat_polygon(count, 2 * k);
            const uint edge = 1u << k | 1u << (k + 1) % count;
            for (uint slot = 0; slot < k_candidate_count; ++slot)
                candidates.points[slot].z = (edge >> candidates.features[slot] & 1u) != 0 ? -1e-4f : 2.0f * k_near;
            EXPECT_EQ(features_of(reduce_points(candidates, no_carriers())) & edge, edge) << count << ", " << k;
        }
    }
}

TEST(BoxBox, reduction_keeps_the_two_that_carried_the_load) {
    for (uint count = 5; count <= 8; ++count) {
        for (uint k = 0; k < count; ++k) {
            Carriers carriers = no_carriers();
            carriers.features[0] = k;
            carriers.features[3] = (k + 1) % count;
            const uint edge = 1u << k | 1u << (k + 1) % count;
            const uint kept = features_of(reduce_points(flat_polygon(count, 3 * k), carriers));
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

TEST(BoxBox, a_strip_is_not_broad_whichever_points_of_it_carry) {
    Samples samples;
    for (int i = 0; i < 2'000; ++i) {
        const bool is_strip = i % 2 == 0;
        const float width = is_strip ? samples.number(1e-3f, 9e-3f) : samples.number(11e-3f, 0.2f);
        const vec4 turn = turned(samples.direction(), samples.number(0.0f, 1e-4f));
        const float along = samples.number(-0.8f, 0.8f);
        Sample sample = aligned_boxes(vec3(0.5f), vec3(0.5f), vec3(1.0f - width, 0.999f, along));
        if (i % 4 < 2) sample.pose_b.position = vec3(along, 0.999f, width - 1.0f);
        sample.pose_b.rotation = turn;
        ContactGeometry g = sample.collide();
        Carriers carriers = no_carriers();
        for (uint k = 0; k < 4; ++k)
            carriers.features[k] = samples.number(0.0f, 1.0f) < 0.5f ? g.features[k] : k_none;
        carriers.axis = 1; // the top of A
        g = collide_shapes(sample.pose_a, sample.shape_a, sample.pose_b, sample.shape_b, carriers, k_margin);
        ASSERT_EQ(g.axis, 1u) << i;
        ASSERT_EQ(g.count, 4u) << i;
        ASSERT_EQ(is_broad(g), !is_strip) << i << ", " << width;
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
        std::ranges::sort(features);
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
