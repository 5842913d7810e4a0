// SPDX-License-Identifier: MIT
// The tree of the broad phase: its order is a Hilbert curve, its boxes hold what is below them, and it finds the pairs
// that brute force finds, whatever the number, the sizes and the places of the bodies.
#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "broad_phase/broad_phase.h"
#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::uint;

// ---- the order ----

TEST(HilbertCurve, goes_through_every_cell_of_a_cube_from_neighbour_to_neighbour) {
    constexpr uint k_side = 16; // the curve is in one piece inside of a cube of a power of two at a multiple of it
    for (const uint corner : {0u, 16u, 496u, 512u, 1008u}) {
        SCOPED_TRACE(corner);
        std::vector<std::pair<uint, std::array<int, 3>>> cells;
        for (uint x = corner; x < corner + k_side; ++x)
            for (uint y = 0; y < k_side; ++y)
                for (uint z = 1008; z < 1008 + k_side; ++z)
                    cells.push_back({engine::hilbert_place(x, y, z),
                                     {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)}});
        std::ranges::sort(cells);
        for (std::size_t i = 1; i < cells.size(); ++i) {
            int apart = 0;
            for (std::size_t axis = 0; axis < 3; ++axis)
                apart += std::abs(cells[i].second[axis] - cells[i - 1].second[axis]);
            ASSERT_EQ(cells[i].first, cells[i - 1].first + 1);
            ASSERT_EQ(apart, 1);
        }
    }
}

TEST(HilbertCurve, begins_at_the_first_cell_and_has_thirty_bits) {
    EXPECT_EQ(engine::hilbert_place(0, 0, 0), 0u);
    uint last = 0;
    for (const uint x : {0u, 1023u})
        for (const uint y : {0u, 1023u})
            for (const uint z : {0u, 1023u})
                last = std::max(last, engine::hilbert_place(x, y, z));
    EXPECT_EQ(last, (1u << 30) - 1);
}

engine::Aabb cube(float centre, float half) {
    engine::Aabb box{};
    box.lower = {centre - half, centre - half, centre - half};
    box.upper = {centre + half, centre + half, centre + half};
    box.movable = 1;
    return box;
}

TEST(TreeKeys, put_small_bodies_before_large_ones_and_empty_slots_last) {
    engine::SpreadSum sum = engine::empty_spread();
    for (int i = 0; i < 1000; ++i)
        sum = engine::add_spreads(sum, engine::spread_of(cube(static_cast<float>(i % 100), 0.5f)));
    const engine::TreeGrid grid = engine::choose_tree_grid(sum, 1000);
    uint before = 0;
    for (const float half : {1.9f, 7.0f, 30.0f, 1e5f}) { // the limits are 2, 8 and 32 times the mean
        const uint key = engine::tree_key(cube(50.0f, half), grid);
        EXPECT_GT(key, before) << half;
        before = key;
    }
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    EXPECT_LT(engine::tree_key(cube(infinity, 1.0f), grid), engine::k_absent_key);
    EXPECT_EQ(engine::tree_key(cube(nan, 1.0f), grid), engine::k_absent_key);
    EXPECT_EQ(engine::tree_key(engine::empty_box(), grid), engine::k_absent_key);
}

TEST(TreeOrder, of_restored_bodies_goes_from_neighbour_to_neighbour_whatever_their_slots) {
    constexpr uint k_side = 8, k_bodies = k_side * k_side * k_side;
    std::vector<engine::Aabb> boxes;
    for (uint i = 0; i < k_bodies; ++i) {
        const engine::vec3 centre(static_cast<float>(i % k_side), static_cast<float>(i / k_side % k_side),
                                  static_cast<float>(i / (k_side * k_side)));
        boxes.push_back({centre - 0.4f, 0.0f, centre + 0.4f, 1u});
    }
    std::ranges::shuffle(boxes, std::mt19937(3));
    boxes[7] = engine::empty_box(); // an empty slot
    const std::vector<uint> order = engine::order_in_tree(boxes);
    EXPECT_EQ(order.back(), 7u);
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), k_bodies);
    for (std::size_t i = 1; i + 1 < order.size(); ++i) {
        const engine::vec3 step = abs(boxes[order[i]].lower - boxes[order[i - 1]].lower);
        EXPECT_LT(step.x + step.y + step.z, 2.1f) << i;
    }
}

TEST(TreeGrid, has_fine_cells_also_far_from_the_origin_and_with_a_body_astray) {
    for (const float far : {0.0f, 1e3f, 1e5f}) {
        SCOPED_TRACE(far);
        engine::SpreadSum sum = engine::empty_spread();
        for (int i = 0; i < 1000; ++i)
            sum = engine::add_spreads(sum, engine::spread_of(cube(far + static_cast<float>(i % 100), 0.5f)));
        EXPECT_GT(engine::choose_tree_grid(sum, 1000).inverse_cell, far > 1e4f ? 0.5f : 5.0f);
        sum = engine::add_spreads(sum, engine::spread_of(cube(far - 1e3f, 0.5f)));
        EXPECT_GT(engine::choose_tree_grid(sum, 1000).inverse_cell, far > 1e4f ? 0.5f : 2.0f);
    }
    const engine::TreeGrid one_place = engine::choose_tree_grid(engine::spread_of(cube(7.0f, 0.5f)), 1);
    EXPECT_TRUE(engine::is_finite(one_place.inverse_cell) && one_place.inverse_cell > 0.0f);
    EXPECT_TRUE(engine::is_finite(engine::choose_tree_grid(engine::empty_spread(), 0).inverse_cell));
}

// ---- the tree ----

/// Random boxes and spheres, one of ten static, one of ten kinematic.
class Bodies {
public:
    explicit Bodies(std::uint32_t seed) : random(seed) {}

    float number(float lower, float upper) { return std::uniform_real_distribution<float>(lower, upper)(random); }

    /// In a cube that gives each a few neighbours; the largest edge is up to `ratio` times the smallest, and most are
    /// near the smallest where the ratio is large.
    std::vector<BodyDefinition> make(std::size_t count, float ratio = 4.0f, Vec3 middle = {}) {
        const float rarity = ratio > 10.0f ? 16.0f : 1.0f;
        const float half = 0.85f * std::cbrt(static_cast<float>(count));
        std::vector<BodyDefinition> bodies;
        for (std::size_t i = 0; i < count; ++i) {
            const float edge = 0.4f * std::pow(ratio, std::pow(number(0.0f, 1.0f), rarity));
            BodyDefinition body = i % 3 == 0 ? sphere_at({}, 0.5f * edge)
                                             : box_at({}, {edge, number(0.3f, 1.0f) * edge, number(0.3f, 1.0f) * edge});
            body.pose = {middle + Vec3{number(-half, half), number(-half, half), number(-half, half)},
                         turn({0.6f, 0.0f, 0.8f}, number(0.0f, 3.0f))};
            body.kind = i % 10 == 4 ? BodyKind::Static : i % 10 == 7 ? BodyKind::Kinematic : BodyKind::Rigid;
            bodies.push_back(body);
        }
        return bodies;
    }

private:
    std::mt19937 random;
};

std::vector<std::pair<uint, uint>> sorted(const std::vector<engine::Pair>& pairs) {
    std::vector<std::pair<uint, uint>> result;
    for (const engine::Pair& pair : pairs)
        result.emplace_back(pair.body_a, pair.body_b);
    std::ranges::sort(result);
    return result;
}

struct RoomyRun : EngineRun {
    RoomyRun(const WorldOptions& options, const std::vector<BodyDefinition>& bodies, uint pair_capacity)
        : EngineRun(options, bodies, weightless()) {
        simulation.reserve_pairs(pair_capacity);
    }
};

class Tree : public OnDevice {
protected:
    RoomyRun run_of(const std::vector<BodyDefinition>& bodies, uint pair_capacity) const {
        return RoomyRun(options_on(GetParam()), bodies, pair_capacity);
    }

    /// Returns how many pairs there are.
    static std::size_t expect_pairs_of_brute_force(RoomyRun& run) {
        const auto searched = sorted(run.find_pairs(BroadPhase::Bvh));
        const auto brute = sorted(run.find_pairs(BroadPhase::Brute));
        EXPECT_EQ(run.counter(engine::k_counter_did_not_fit), 0u);
        EXPECT_TRUE(searched == brute) << searched.size() << " pairs by the tree, " << brute.size() << " by force";
        return brute.size();
    }
};

TEST_P(Tree, finds_the_pairs_of_any_number_of_bodies) {
    for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 16u, 17u, 63u, 64u, 65u, 255u, 256u, 257u, 1025u, 4095u}) {
        SCOPED_TRACE(count);
        RoomyRun run = run_of(Bodies(static_cast<std::uint32_t>(count)).make(count), 65'536);
        const std::size_t found = expect_pairs_of_brute_force(run);
        if (count > 60) {
            EXPECT_GT(found, count / 5) << "the scene must have pairs";
        }
    }
}

TEST_P(Tree, finds_the_pairs_of_bodies_of_very_different_sizes) {
    std::vector<BodyDefinition> bodies = Bodies(3).make(1500, 1000.0f);
    bodies.push_back(box_at({0.0f, -60.0f, 0.0f}, {5e4f, 100.0f, 5e4f}, BodyKind::Static));
    bodies.push_back(sphere_at({1.0f, 2.0f, 3.0f}, 9e4f));
    RoomyRun run = run_of(bodies, 200'000);
    EXPECT_GT(expect_pairs_of_brute_force(run), 10'000u);
}

TEST_P(Tree, finds_all_pairs_of_bodies_in_one_place) {
    std::vector<BodyDefinition> bodies(300, box_at({3.0f, 2.0f, 1.0f}));
    RoomyRun run = run_of(bodies, 65'536);
    EXPECT_EQ(expect_pairs_of_brute_force(run), 300u * 299u / 2u);
    const auto pairs = run.find_pairs(BroadPhase::Bvh);
    EXPECT_TRUE(std::ranges::is_sorted(pairs, {}, [](const engine::Pair& pair) {
        return std::pair(pair.body_a, pair.body_b);
    })) << "bodies of one cell stay in the order of their slots";
}

TEST_P(Tree, finds_the_pairs_far_from_the_origin_and_with_a_body_astray) {
    std::vector<BodyDefinition> bodies = Bodies(4).make(500, 4.0f, {8e5f, -3e5f, 9e5f});
    RoomyRun far = run_of(bodies, 65'536);
    EXPECT_GT(expect_pairs_of_brute_force(far), 100u);
    bodies.push_back(box_at({-1e6f, 0.0f, 0.0f}));
    RoomyRun astray = run_of(bodies, 65'536);
    expect_pairs_of_brute_force(astray);
}

TEST_P(Tree, leaves_out_bodies_without_a_place_and_finds_all_others) {
    const std::vector<BodyDefinition> bodies = Bodies(5).make(400);
    RoomyRun run = run_of(bodies, 65'536);
    std::size_t before = expect_pairs_of_brute_force(run);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    for (const auto& [x, y] : {std::pair{nan, 0.0f}, {0.0f, nan}, {infinity, 0.0f}, {0.0f, -infinity}}) {
        const uint slot = run.find_pairs(BroadPhase::Bvh)[before / 2].body_a;
        engine::BodyPose lost = run.table.poses[slot];
        lost.position.x = x;
        lost.position.y = y;
        run.simulation.write(BufferId::Poses, slot, std::span<const engine::BodyPose>(&lost, 1));
        const std::size_t after = expect_pairs_of_brute_force(run);
        EXPECT_LT(after, before);
        EXPECT_GT(after, before / 2);
        before = after;
    }
}

TEST_P(Tree, has_room_for_bodies_that_come_and_none_for_those_that_go) {
    World world = make_world(weightless()), expected = make_world(weightless());
    Settings settings = world.settings();
    settings.broad_phase = BroadPhase::Bvh;
    world.set_settings(settings);
    for (const std::size_t count : {1u, 70u, 150u}) { // past the room for 64 bodies that a world begins with
        for (World* each : {&world, &expected}) {
            each->add(Bodies(static_cast<std::uint32_t>(count)).make(count));
            const std::vector<BodyId> ids = each->bodies();
            for (std::size_t i = 0; i < ids.size(); i += 4)
                each->remove(ids[i]);
            each->step(2);
        }
        EXPECT_EQ(world.collision_pairs().size(), expected.collision_pairs().size());
        EXPECT_EQ(world.state_hash(), expected.state_hash());
    }
    for (const BodyId id : world.bodies())
        world.remove(id);
    world.step();
    EXPECT_TRUE(world.collision_pairs().empty());
}

TEST_P(Tree, is_the_same_each_time_and_its_boxes_hold_what_is_below_them) {
    constexpr uint k_count = 1100; // more than a work group treats, and no power of four
    RoomyRun run = run_of(Bodies(8).make(k_count, 50.0f), 65'536);
    const uint top = engine::tree_top(k_count), node_count = engine::tree_node(0, 0, top) + k_count;
    const auto first = run.find_pairs(BroadPhase::Bvh);
    const auto nodes = run.read<engine::Aabb>(BufferId::TreeNodes, node_count);
    const auto again = run.find_pairs(BroadPhase::Bvh);
    EXPECT_TRUE(std::ranges::equal(first, again, [](const engine::Pair& a, const engine::Pair& b) {
        return a.body_a == b.body_a && a.body_b == b.body_b;
    }));
    const auto order = run.read<uint>(BufferId::SortValues, k_count);
    const auto boxes = run.read<engine::Aabb>(BufferId::Aabbs, k_count);
    for (uint shift = 0; shift <= top; shift += engine::k_tree_bits) {
        for (uint node = 0; node < engine::tree_level_size(k_count, shift); ++node) {
            engine::Aabb expected = engine::empty_box();
            for (uint place = node << shift; place < std::min(k_count, (node + 1) << shift); ++place)
                expected = engine::unite_boxes(expected, boxes[order[place]]);
            const engine::Aabb& box = nodes[engine::tree_node(node << shift, shift, top)];
            ASSERT_TRUE(box.lower == expected.lower && box.upper == expected.upper) << shift << ", " << node;
            ASSERT_EQ(box.movable, expected.movable);
        }
    }
}

TEST_P(Tree, is_that_of_the_cpu_word_by_word) {
    constexpr uint k_count = 3000; // more than one work group sorts
    const std::vector<BodyDefinition> bodies = Bodies(9).make(k_count, 100.0f);
    RoomyRun run = run_of(bodies, 65'536), expected(options_on(DeviceKind::Cpu), bodies, 65'536);
    run.find_pairs(BroadPhase::Bvh);
    expected.find_pairs(BroadPhase::Bvh);
    const uint pair_count = expected.counter(engine::k_counter_pair_count);
    EXPECT_GT(pair_count, k_count);
    const uint first_leaf = engine::tree_node(0, 0, engine::tree_top(k_count));
    const std::tuple<BufferId, std::size_t> made[]{
        {BufferId::TreeGrids, 8},        {BufferId::SortKeys, k_count},
        {BufferId::SortValues, k_count}, {BufferId::TreeNodes, 8 * (std::size_t{first_leaf} + k_count)},
        {BufferId::PairCounts, k_count}, {BufferId::Pairs, 2 * std::size_t{pair_count}},
    };
    for (const auto& [buffer, words] : made)
        EXPECT_TRUE(run.read<uint>(buffer, words) == expected.read<uint>(buffer, words))
            << engine::k_buffers[static_cast<std::size_t>(buffer)].block;
}

TEST_P(Tree, never_loses_a_pair_in_silence_where_a_driver_ends_long_loops) {
    // A sphere first in the order, and so many static boxes in it that its search takes more than 65,535 rounds.
    constexpr uint k_inside = 49'500;
    std::vector<BodyDefinition> bodies{sphere_at({}, 40.0f)};
    bodies.resize(1 + k_inside, box_at({}, {30.0f, 30.0f, 30.0f}, BodyKind::Static));
    for (int i = 0; i < 1000; ++i) // they make the others count as large, and lie at the far end of the curve
        bodies.push_back(sphere_at({1e3f + static_cast<float>(i % 10), 1e3f, 1e3f + static_cast<float>(i / 10)}, 0.1f));
    RoomyRun run = run_of(bodies, 65'536);
    const auto pairs = run.find_pairs(BroadPhase::Bvh);
    if (run.simulation.state_device().loops_freely()) {
        EXPECT_EQ(pairs.size(), k_inside);
        EXPECT_EQ(run.counter(engine::k_counter_did_not_fit), 0u);
        return;
    }
    EXPECT_EQ(pairs.size(), 0u);
    EXPECT_EQ(run.counter(engine::k_counter_did_not_fit), engine::k_fit_search);
    run.settings.broad_phase = BroadPhase::Bvh;
    run.simulation.set_settings(run.settings);
    const std::string error = error_of([&] { run.step(); });
    EXPECT_NE(error.find("does not search the tree of the broad phase to the end"), std::string::npos) << error;
}

// A hybrid world's broad phase is that of the GPU.
INSTANTIATE_TEST_SUITE_P(Devices, Tree, testing::Values(DeviceKind::Cpu, DeviceKind::Gpu),
                         [](const auto& test) { return name_of(test.param); });

} // namespace
} // namespace talus::tests
