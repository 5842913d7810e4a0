// SPDX-License-Identifier: MIT
// One step from the same state on the CPU and on the GPU, compared buffer by buffer after every stage.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "parity.h"
#include "state/stages.h"
#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

using engine::BufferParity;
using engine::ParityReport;

struct Case {
    const char* scene;
    std::uint32_t steps; // until the state is interesting: resting, or in the middle of the fall
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.scene;
}

class Parity : public testing::TestWithParam<Case> {};

void expect_parity(const ParityReport& report) {
    std::set<std::string> stages;
    for (const BufferParity& row : report.rows) {
        SCOPED_TRACE(row.buffer + " after " + row.stage);
        EXPECT_EQ(row.integers_differ, 0u);
        EXPECT_LE(row.largest_error, engine::k_parity_tolerance);
        EXPECT_GT(row.words, 0u);
        stages.insert(row.stage);
    }
    for (const char* stage : stage_names())
        EXPECT_TRUE(stages.contains(stage)) << "no buffer was compared after " << stage;
    EXPECT_TRUE(report.integers_agree());
    EXPECT_LE(report.largest_error(), engine::k_parity_tolerance);
}

TEST_P(Parity, every_stage_gives_the_same_on_both_devices) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    const scenes::Scene scene = scenes::make_scene(GetParam().scene);
    expect_parity(engine::compare_devices(bodies_of(GetParam().scene), scene.settings, GetParam().steps));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Parity,
                         testing::Values(Case{"stack", 0}, Case{"stack", 30}, Case{"pool:boxes=100", 90},
                                         Case{"extreme_stack", 5}, Case{"pyramid:base=10", 30},
                                         Case{"wall:width=10,height=8", 30}, Case{"columns:side=11,height=10", 5},
                                         Case{"grid:stacks=30", 10}, Case{"pile:boxes=150", 90},
                                         Case{"pile:boxes=150", 95}));

TEST(ParityOfMixedBodies, holds_for_spheres_spin_bounces_and_the_other_settings) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    const std::vector<BodyDefinition> bodies = mixed_bodies();
    Settings settings;
    expect_parity(engine::compare_devices(bodies, settings, 40));
    settings.stabilisation = Stabilisation::Baumgarte;
    settings.iterations = 8;
    for (const BroadPhase broad_phase : {BroadPhase::Brute, BroadPhase::Bvh}) {
        settings.broad_phase = broad_phase;
        expect_parity(engine::compare_devices(bodies, settings, 40));
    }
}

TEST(ParityOfSleepers, holds_where_parts_of_a_heap_sleep) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    const char* const scene = "pile:boxes=1500";
    Settings settings = scenes::make_scene(scene).settings;
    settings.sleeping = true;
    // 1,238 of them sleep then.
    const ParityReport report = engine::compare_devices(bodies_of(scene), settings, 420);
    expect_parity(report);
    const auto is_list = [](const BufferParity& row) { return row.buffer == "ListedPairs"; };
    EXPECT_TRUE(std::ranges::any_of(report.rows, is_list)) << "all are awake, or the last graph was this step's";
}

TEST(ParityOfMixedBodies, holds_for_sensors) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    std::vector<BodyDefinition> bodies = mixed_bodies();
    for (std::size_t i = 5; i < bodies.size(); i += 5)
        bodies[i].sensor = true;
    bodies.push_back(box_at({2.0f, 1.0f, 0.0f}, {4.0f, 2.0f, 4.0f}, BodyKind::Static));
    bodies.back().sensor = true;
    expect_parity(engine::compare_devices(bodies, {}, 30));
}

TEST(ParityOfMixedBodies, holds_where_colours_run_out) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    expect_parity(engine::compare_devices(plate_of(9), {}, 5));
    expect_parity(engine::compare_devices(plate_of(9), with_hubs(), 5));
    expect_parity(engine::compare_devices(table_on_legs(8, 2), with_hubs(), 5));
    Settings sequential;
    sequential.solve_order = SolveOrder::Sequential;
    expect_parity(engine::compare_devices(bodies_of("pyramid:base=5"), sequential, 5));
}

} // namespace
} // namespace talus::tests
