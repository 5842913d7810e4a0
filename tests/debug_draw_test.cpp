// SPDX-License-Identifier: MIT
// Debug drawing: what an implementation gets to draw, for worlds whose picture is known.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

struct Line {
    Vec3 from, to;
    Colour colour;
};

struct Drawing final : DebugDraw {
    void line(Vec3 from, Vec3 to, const Colour& colour) override { lines.push_back({from, to, colour}); }
    void point(Vec3 position, float, const Colour&) override { points.push_back(position); }
    void text(Vec3 position, std::string_view words, const Colour&) override {
        texts.emplace_back(words);
        points.push_back(position);
    }
    std::vector<Line> lines;
    std::vector<Vec3> points;
    std::vector<std::string> texts;
};

class DebugDrawing : public testing::Test {
protected:
    Drawing drawn(const DebugDrawOptions& options) const {
        Drawing drawing;
        draw_debug(world, drawing, options);
        return drawing;
    }
    static DebugDrawOptions nothing() {
        DebugDrawOptions options;
        options.shapes = options.contacts = false;
        return options;
    }
    World world{weightless(), options_on(DeviceKind::Cpu)};
};

TEST_F(DebugDrawing, of_a_box_is_its_twelve_edges) {
    BodyDefinition box = box_at({1.0f, 2.0f, 3.0f}, {2.0f, 4.0f, 6.0f});
    box.pose.rotation = turn({0.0f, 1.0f, 0.0f}, 0.5f);
    world.add(box);
    const Drawing drawing = drawn({});
    ASSERT_EQ(drawing.lines.size(), 12u);
    std::vector<float> lengths;
    for (const Line& line : drawing.lines) {
        lengths.push_back(length(line.to - line.from));
        for (const Vec3& end : {line.from, line.to})
            EXPECT_NEAR(length(end - box.pose.position), std::sqrt(1.0f + 4.0f + 9.0f), 1e-5f);
    }
    std::ranges::sort(lengths);
    for (int i = 0; i < 12; ++i)
        EXPECT_NEAR(lengths[static_cast<std::size_t>(i)], 2.0f * static_cast<float>(1 + i / 4), 1e-5f);
}

TEST_F(DebugDrawing, of_a_sphere_is_three_circles) {
    world.add(sphere_at({0.0f, 5.0f, 0.0f}, 0.25f));
    const Drawing drawing = drawn({});
    EXPECT_EQ(drawing.lines.size() % 3, 0u);
    EXPECT_GE(drawing.lines.size(), 3u * 12u);
    for (const Line& line : drawing.lines)
        EXPECT_NEAR(length(line.from - Vec3{0.0f, 5.0f, 0.0f}), 0.25f, 1e-6f);
}

TEST_F(DebugDrawing, of_bounding_boxes_encloses_the_bodies) {
    BodyDefinition box = box_at({});
    box.pose.rotation = turn({0.0f, 0.0f, 1.0f}, 0.785398163f); // 45 degrees
    world.add(box);
    DebugDrawOptions options = nothing();
    options.aabbs = true;
    const Drawing drawing = drawn(options);
    ASSERT_EQ(drawing.lines.size(), 12u);
    for (const Line& line : drawing.lines) {
        EXPECT_NEAR(std::abs(line.from.x), std::sqrt(0.5f), 1e-5f);
        EXPECT_NEAR(std::abs(line.from.y), std::sqrt(0.5f), 1e-5f);
        EXPECT_NEAR(std::abs(line.from.z), 0.5f, 1e-5f);
    }
}

TEST_F(DebugDrawing, tells_kinds_and_sensors_apart_by_colour) {
    std::vector<Colour> colours;
    for (const BodyKind kind : {BodyKind::Static, BodyKind::Rigid, BodyKind::Kinematic}) {
        const BodyId id = world.add(box_at({}, {1.0f, 1.0f, 1.0f}, kind));
        colours.push_back(drawn({}).lines.front().colour);
        world.set_sensor(id, true);
        colours.push_back(drawn({}).lines.front().colour);
        world.remove(id);
    }
    const auto same = [&](std::size_t i, std::size_t j) {
        return colours[i].red == colours[j].red && colours[i].green == colours[j].green &&
               colours[i].blue == colours[j].blue;
    };
    EXPECT_FALSE(same(0, 2) || same(2, 4) || same(0, 4) || same(0, 1));
    EXPECT_TRUE(same(1, 3) && same(3, 5));
}

TEST_F(DebugDrawing, of_contacts_has_their_points_normals_and_impulses) {
    world.set_settings({});
    world.add(ground());
    const BodyId box = world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.step(30);
    DebugDrawOptions options = nothing();
    options.contacts = options.impulses = true;
    options.normal_length = 0.5f;
    options.impulse_scale = 0.001f;
    const Drawing drawing = drawn(options);
    ASSERT_EQ(drawing.points.size(), 4u);
    ASSERT_EQ(drawing.lines.size(), 8u);
    float impulse = 0.0f;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 way = drawing.lines[i].to - drawing.lines[i].from;
        EXPECT_NEAR(drawing.lines[i].from.y, 0.0f, 1e-2f);
        EXPECT_FLOAT_EQ(way.x, 0.0f);
        if (i % 2 == 0)
            EXPECT_NEAR(way.y, 0.5f, 1e-5f);
        else
            impulse += way.y / 0.001f;
    }
    EXPECT_NEAR(impulse, world.mass(box) * 9.81f / 60.0f, 0.5f) << "the four together carry the box";
}

TEST_F(DebugDrawing, has_pairs_velocities_and_indices) {
    world.add(box_at({}));
    BodyDefinition other = box_at({1.0f, 0.0f, 0.0f});
    other.velocity.linear = {0.0f, 0.0f, 2.0f};
    world.add(other);
    world.step();
    DebugDrawOptions options = nothing();
    options.pairs = options.velocities = options.indices = true;
    const Drawing drawing = drawn(options);
    EXPECT_EQ(drawing.texts, (std::vector<std::string>{"0", "1"}));
    ASSERT_EQ(drawing.lines.size(), 3u);
    EXPECT_GT(drawing.lines[1].to.z - drawing.lines[1].from.z, 0.1f);
    EXPECT_EQ(drawing.lines[2].from, world.poses()[0].position);
    EXPECT_EQ(drawing.lines[2].to, world.poses()[1].position);
    EXPECT_TRUE(drawn(nothing()).lines.empty());
}

} // namespace
} // namespace talus::tests
