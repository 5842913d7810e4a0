// SPDX-License-Identifier: MIT
// The benchmark: what `talus bench` prints and writes, how it compares with an earlier run, and that the other engine
// plays the scene that it is given.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <regex>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/bench_options.h"
#include "bench/comparison.h"
#include "bench/measurement.h"
#include "bench/peer.h"
#include "program.h"

namespace talus::bench {
namespace {

using nlohmann::json;
using Json = nlohmann::ordered_json;
using tests::Ending;

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

std::vector<json> lines_of(const std::string& text) {
    std::vector<json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(json::parse(line));
    return lines;
}

/// Keys at every depth, as /step_ms/median.
std::vector<std::string> paths_of(const json& object) {
    std::vector<std::string> paths;
    const json flat = object.flatten();
    for (const auto& [path, value] : flat.items())
        paths.push_back(path);
    return paths;
}

// ---- the command ----

class Bench : public tests::Program {
protected:
    Ending bench(const std::string& arguments) const { return talus("bench --devices cpu " + arguments); }
};

TEST_F(Bench, prints_a_line_for_each_scene) {
    const Ending ending = bench("stack:height=2 pool:boxes=5 --steps 10 --stages --repeat 2");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    EXPECT_EQ(ending.errors, "");
    for (const char* part : {"stack:height=2", "pool:boxes=5", "median ms", "spread", "drift", "overlap", "J/body"})
        EXPECT_TRUE(contains(ending.output, part)) << part << " is missing in\n" << ending.output;
    for (const char* stage : stage_names())
        EXPECT_TRUE(contains(ending.output, std::string(stage) + " ")) << stage;
}

TEST_F(Bench, json_lines_are_the_reports_of_run) {
    // Two threads that solve islands at the same time keep memory for each.
    const Ending ending = bench("stack:height=2 pool:boxes=5 --steps 10 --threads 1 --json");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    EXPECT_TRUE(contains(ending.errors, "median ms")); // the table
    const std::vector<json> lines = lines_of(ending.output);
    ASSERT_EQ(lines.size(), 2u);
    for (const json& line : lines) {
        const std::string scene = line["scene"];
        ASSERT_EQ(run_on_cpu("'" + scene + "' --steps 10 --threads 1 --report run.json").status, 0);
        const json report = json_of("run.json");
        EXPECT_EQ(paths_of(line), paths_of(report));
        for (const char* key : {"scene", "device", "threads", "steps", "dt", "bodies", "contacts", "quality",
                                "memory_bytes", "state_hash"})
            EXPECT_EQ(line[key], report[key]) << scene << ' ' << key;
        EXPECT_GT(line["step_ms"]["median"], 0.0);
        EXPECT_TRUE(line["stages_ms"]["solve"].is_null()); // not measured without --stages
    }
}

TEST_F(Bench, solver_options_reach_the_solver) {
    const Ending ending = bench("stack --steps 3 --stabilisation baumgarte --iterations 7 --dt 0.01 --json");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    const json line = json::parse(ending.output);
    EXPECT_EQ(line["stabilisation"], "baumgarte");
    EXPECT_EQ(line["iterations"], 7);
    EXPECT_EQ(line["dt"].get<float>(), 0.01f);
}

TEST_F(Bench, repeats_end_in_the_same_state) {
    const Ending ending = bench("pool:boxes=5 --steps 20 --repeat 3 --json");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    const std::vector<json> lines = lines_of(ending.output);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0]["state_hash"], lines[1]["state_hash"]);
    EXPECT_EQ(lines[0]["state_hash"], lines[2]["state_hash"]);
}

TEST_F(Bench, measures_cost_over_size) {
    const Ending ending = bench("--size-curves sizes.csv --sizes 5,60 --steps 4 grid pile");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    std::istringstream csv(text_of(folder / "sizes.csv"));
    std::string line;
    std::getline(csv, line);
    EXPECT_TRUE(line.starts_with("family,scene,device,device_name,threads,boxes,")) << line;
    EXPECT_TRUE(line.ends_with(",finish_ms")) << line;
    const auto fields = std::ranges::count(line, ',');
    for (const char* head : {"grid,\"grid:stacks=1\",cpu,", "grid,\"grid:stacks=12\",cpu,",
                             "pile,\"pile:boxes=5,seed=1\","
                             "cpu,",
                             "pile,\"pile:boxes=60,seed=1\",cpu,"}) {
        ASSERT_TRUE(std::getline(csv, line));
        std::string plain = line;
        EXPECT_TRUE(plain.starts_with(head)) << plain;
        EXPECT_GE(std::ranges::count(plain, ','), fields);
    }
    EXPECT_FALSE(std::getline(csv, line));

    const Ending refused = bench("--size-curves sizes.csv wall");
    EXPECT_EQ(refused.status, 2);
    EXPECT_TRUE(contains(refused.errors, "'wall' is not one of grid, pile")) << refused.errors;
}

TEST_F(Bench, replaces_bodies_before_each_step) {
    const Ending calm = bench("stack:height=3 --steps 40 --json"),
                 churned = bench("stack:height=3 --steps 40 --churn 3 --json");
    ASSERT_EQ(churned.status, 0) << churned.errors;
    const json moved = json::parse(calm.output), put_back = json::parse(churned.output);
    EXPECT_EQ(put_back["bodies"], moved["bodies"]);
    EXPECT_EQ(put_back["contacts"], moved["contacts"]);
    EXPECT_NE(put_back["state_hash"], moved["state_hash"]); // each box has had a single step since it was put there
    EXPECT_LT(put_back["quality"]["max_drift"], 1e-3);
}

TEST_F(Bench, compares_with_an_earlier_run) {
    const Ending first = bench("stack:height=2 pool:boxes=5 --steps 10 --json");
    ASSERT_EQ(first.status, 0) << first.errors;
    std::vector<json> earlier = lines_of(first.output);
    ASSERT_EQ(earlier.size(), 2u);
    earlier[0]["step_ms"]["median"] = 1e-6; // nothing is that fast
    earlier[1]["step_ms"]["median"] = 1e6;
    {
        std::ofstream file(folder / "earlier.jsonl");
        file << earlier[0] << "\n\n" << earlier[1] << '\n';
    }
    const Ending ending =
        bench("stack:height=2 pool:boxes=5 stack:height=3 --steps 12 --threads 1 --against earlier.jsonl");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    EXPECT_TRUE(contains(ending.output, "SLOWER")) << ending.output;
    EXPECT_TRUE(contains(ending.output, "faster")) << ending.output;
    EXPECT_TRUE(contains(ending.output, "not measured earlier")) << ending.output;
    EXPECT_TRUE(contains(ending.output, "steps was 10, is 12")) << ending.output;
}

TEST_F(Bench, solver_curves_have_a_point_for_each_number_of_passes) {
    const Ending ending = bench("stack:height=2 --steps 4 --solver-curves curves.csv");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    std::istringstream file(text_of(folder / "curves.csv"));
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    EXPECT_EQ(line, "scene,stabilisation,solve_order,passes,steps,max_drift_m,max_drift_sideways_m,max_penetration_m,"
                    "kinetic_energy_j_a_body,escaped_bodies,nonfinite_bodies,median_ms");
    std::vector<std::string> starts;
    while (std::getline(file, line))
        starts.push_back(line.substr(0, line.find(",4,")));
    ASSERT_EQ(starts.size(), 40u);
    EXPECT_EQ(starts.front(), "\"stack:height=2\",baumgarte,coloured,1");
    EXPECT_EQ(starts[12], "\"stack:height=2\",baumgarte,coloured,150");
    EXPECT_EQ(starts[13], "\"stack:height=2\",soft,coloured,1");
    EXPECT_EQ(starts[20], "\"stack:height=2\",baumgarte,sequential,1");
    EXPECT_EQ(starts.back(), "\"stack:height=2\",soft,sequential,64");
}

TEST_F(Bench, broad_phases_stand_side_by_side_and_find_the_same_pairs) {
    const Ending ending = bench("stack:height=3 rubble:boxes=200 --steps 30 --broad-phases sides.csv");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    std::istringstream file(text_of(folder / "sides.csv"));
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    EXPECT_EQ(line, "scene,device,bodies,broad_phase,steps,pairs,broad_phase_ms,median_ms");
    const std::regex row(R"re("([^"]+)",cpu,(\d+),(sap|bvh|brute),30,(\d+),([0-9.e-]+),([0-9.e-]+))re");
    std::vector<std::string> words, pairs;
    for (std::smatch match; std::getline(file, line);) {
        ASSERT_TRUE(std::regex_match(line, match, row)) << line;
        EXPECT_EQ(match[2], words.size() < 3 ? "4" : "205");
        EXPECT_GT(std::stod(match[5]), 0.0);
        EXPECT_GT(std::stod(match[6]), 0.0);
        words.push_back(match[3]);
        pairs.push_back(match[4]);
    }
    EXPECT_EQ(words, (std::vector<std::string>{"sap", "bvh", "brute", "sap", "bvh", "brute"}));
    ASSERT_EQ(pairs.size(), 6u);
    EXPECT_EQ(pairs[0], "3");
    EXPECT_GT(std::stoul(pairs[3]), 200u);
    for (const std::size_t i : {1u, 2u, 4u, 5u})
        EXPECT_EQ(pairs[i], pairs[i - i % 3]);
}

TEST_F(Bench, bad_usage_ends_with_2_and_says_what_is_allowed) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"bench stak", "stack"},
        {"bench stack none.glb", "none.glb"},
        {"bench stack --devices cpu,tpu", "'tpu' is not one of auto, gpu, cpu, hybrid"},
        {"bench stack --devices cpu,cpu", "listed twice"},
        {"bench stack --steps 1", "--steps"},
        {"bench stack --repeat 0", "--repeat"},
        {"bench stack --threads 0", "--threads"},
        {"bench stack --peer physx", "'physx' is not one of bullet"},
        {"bench stack --against none.jsonl", "cannot read none.jsonl"},
        {"bench stack --devices cpu --against /dev/null", "holds no report"},
        {"bench --solver-curves a.csv --json", "--json"},
        {"bench --solver-curves none/a.csv", "none/a.csv"},
        {"bench stack --solver-curves .", "folder"},
        {"bench --broad-phases a.csv --json", "--json"},
        {"bench --broad-phases a.csv --broad-phase bvh", "--broad-phase"},
        {"bench --broad-phases a.csv --solver-curves b.csv", "--solver-curves"},
        {"bench --broad-phases a.csv --devices cpu,gpu", "--devices names several"},
        {"bench --broad-phases none/a.csv", "none/a.csv"},
    };
    for (const auto& [arguments, expected] : cases) {
        const Ending ending = talus(arguments);
        EXPECT_EQ(ending.status, 2) << arguments;
        EXPECT_EQ(ending.output, "") << arguments;
        EXPECT_TRUE(contains(ending.errors, expected)) << arguments << ": " << ending.errors;
        EXPECT_TRUE(folder_is_empty()) << arguments;
    }
}

TEST_F(Bench, a_broken_earlier_run_is_refused_with_its_line) {
    const Ending good = bench("stack:height=1 --steps 2 --json");
    ASSERT_EQ(good.status, 0) << good.errors;
    const json row = json::parse(good.output);
    json without_time = row, without_scene = row, no_time = row;
    without_time["step_ms"].erase("median");
    without_scene["scene"] = 3;
    no_time["step_ms"]["median"] = 0.0;
    const std::vector<std::pair<std::string, std::string>> cases{
        {"[1]", "not a JSON object"},
        {"{\"scene\": ", "not a JSON object"},
        {without_time.dump(), "no number at /step_ms/median"},
        {without_scene.dump(), "no text at /scene"},
        {no_time.dump(), "is not positive"},
    };
    for (const auto& [second_line, expected] : cases) {
        std::ofstream(folder / "earlier.jsonl") << row << '\n' << second_line << '\n';
        const Ending ending = bench("stack:height=1 --steps 2 --against earlier.jsonl");
        EXPECT_EQ(ending.status, 2) << second_line;
        EXPECT_EQ(ending.output, "") << second_line;
        EXPECT_TRUE(contains(ending.errors, "earlier.jsonl, line 2: ")) << ending.errors;
        EXPECT_TRUE(contains(ending.errors, expected)) << ending.errors;
    }
}

// ---- the comparison ----

Json row_of(const std::string& scene, double median_ms) {
    return {{"scene", scene},
            {"device", {{"kind", "cpu"}, {"name", "a CPU"}}},
            {"step_ms", {{"median", median_ms}}},
            {"quality", {{"max_drift", 0.01}, {"max_penetration", 0.002}}}};
}

TEST(Comparison, flags_changes_beyond_five_percent_of_the_median_round) {
    const std::vector<Json> earlier{row_of("a", 100.0), row_of("b", 100.0), row_of("c", 100.0), row_of("b", 1.0),
                                    row_of("b", 300.0)};
    const std::string text = compare_rows(earlier, {row_of("a", 104.9), row_of("b", 105.2), row_of("c", 94.8)});
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    ASSERT_EQ(lines.size(), 4u) << text;
    EXPECT_TRUE(contains(lines[1], " 1.049 "));
    EXPECT_FALSE(contains(lines[1], "SLOWER"));
    EXPECT_TRUE(contains(lines[2], " 1.052 SLOWER")) << text; // the middle one of 1, 100 and 300
    EXPECT_TRUE(contains(lines[3], " 0.948 faster")) << text;
}

// ---- the peer ----

class BulletPeer : public testing::Test {
protected:
    void SetUp() override {
        if (!TALUS_HAS_BULLET) GTEST_SKIP() << "built without Bullet (Debian: libbullet-dev)";
    }

    BodyDefinition& add(BodyKind kind, Shape shape, Vec3 position) {
        BodyDefinition body;
        body.kind = kind;
        body.shape = shape;
        body.pose.position = position;
        scene.bodies.push_back({"body", body});
        return scene.bodies.back().definition;
    }
    void add_floor(Material material = {}) {
        add(BodyKind::Static, Box{{200.0f, 2.0f, 200.0f}}, {0.0f, -1.0f, 0.0f}).material = material;
    }

    std::vector<cli::BodySample> after(int steps) {
        WorldOptions options;
        options.device = DeviceKind::Cpu;
        World world(scene.settings, options);
        for (const scenes::NamedBody& body : scene.bodies)
            world.add(body.definition);
        const std::unique_ptr<Peer> peer = make_bullet(scene, scene.settings, cli::sample_bodies(world));
        for (int i = 0; i < steps; ++i)
            peer->step();
        counts = peer->counts();
        return peer->samples();
    }

    scenes::Scene scene;
    PeerCounts counts;
};

TEST_F(BulletPeer, bodies_fall_as_their_gravity_and_damping_ask) {
    add(BodyKind::Rigid, Sphere{0.5f}, {0.0f, 50.0f, 0.0f});
    add(BodyKind::Rigid, Sphere{0.5f}, {5.0f, 50.0f, 0.0f}).gravity_scale = 0.5f;
    BodyDefinition& damped = add(BodyKind::Rigid, Box{}, {10.0f, 50.0f, 0.0f});
    damped.gravity_scale = 0.0f;
    damped.velocity.linear = {0.0f, 0.0f, 3.0f};
    damped.velocity.angular = {0.0f, 2.0f, 0.0f};
    damped.linear_damping = 0.5f;
    damped.angular_damping = 1.5f;
    const std::vector<cli::BodySample> bodies = after(60);
    // 60 steps of semi-implicit Euler: g dt² (1 + 2 + … + 60)
    const float fallen = 9.81f / 3600.0f * 1830.0f;
    EXPECT_NEAR(bodies[0].pose.position.y, 50.0f - fallen, 1e-3f);
    EXPECT_NEAR(bodies[1].pose.position.y, 50.0f - 0.5f * fallen, 1e-3f);
    EXPECT_NEAR(bodies[2].velocity.linear.z, 3.0f * std::exp(-0.5f), 1e-3f);
    EXPECT_NEAR(bodies[2].velocity.angular.y, 2.0f * std::exp(-1.5f), 1e-3f);
}

TEST_F(BulletPeer, masses_and_inertias_are_those_of_talus) {
    // Two boxes meet head on; the lighter one bounces back as its share of the mass has it.
    scene.settings.gravity = {};
    Material elastic;
    elastic.restitution = 1.0f;
    elastic.friction = 0.0f;
    for (const auto& [x, mass, speed] : {std::tuple{-2.0f, 3.0f, 2.0f}, std::tuple{2.0f, 1.0f, -2.0f}}) {
        BodyDefinition& sphere = add(BodyKind::Rigid, Sphere{0.5f}, {x, 0.0f, 0.0f});
        sphere.mass = mass;
        sphere.inertia = Vec3{mass, mass, mass};
        sphere.velocity.linear.x = speed;
        sphere.material = elastic;
    }
    const std::vector<cli::BodySample> bodies = after(120);
    EXPECT_NEAR(bodies[0].velocity.linear.x, 0.0f, 0.01f);
    EXPECT_NEAR(bodies[1].velocity.linear.x, 4.0f, 0.01f);
    EXPECT_EQ(bodies[0].mass, 3.0f);
    EXPECT_EQ(bodies[0].inertia, (Vec3{3.0f, 3.0f, 3.0f}));
}

TEST_F(BulletPeer, friction_is_combined_by_the_rules_of_talus) {
    struct Rule {
        Combine floor, box;
        float friction; ///< that comes of 0.1 and 0.9
    };
    for (const auto& [floor, box, friction] :
         {Rule{Combine::Average, Combine::Maximum, 0.5f}, Rule{Combine::Minimum, Combine::Maximum, 0.1f},
          Rule{Combine::Maximum, Combine::Multiply, 0.9f}, Rule{Combine::Multiply, Combine::Multiply, 0.09f}}) {
        scene.bodies.clear();
        add_floor({.friction = 0.1f, .friction_combine = floor});
        BodyDefinition& sliding = add(BodyKind::Rigid, Box{{1.0f, 0.2f, 1.0f}}, {0.0f, 0.1f, 0.0f});
        sliding.velocity.linear.x = 3.0f;
        sliding.material = {.friction = 0.9f, .friction_combine = box};
        const float stops_at = 9.0f / (2.0f * friction * 9.81f);
        EXPECT_NEAR(after(600)[1].pose.position.x, stops_at, 0.03f * stops_at + 0.01f);
    }
}

TEST_F(BulletPeer, kinematic_bodies_follow_their_velocity_and_carry_what_lies_on_them) {
    BodyDefinition& belt = add(BodyKind::Kinematic, Box{{10.0f, 1.0f, 4.0f}}, {0.0f, -0.5f, 0.0f});
    belt.velocity.linear.x = 0.5f;
    belt.material.friction = 1.0f;
    add(BodyKind::Rigid, Box{}, {0.0f, 0.5f, 0.0f}).material.friction = 1.0f;
    const std::vector<cli::BodySample> bodies = after(120);
    EXPECT_NEAR(bodies[0].pose.position.x, 1.0f, 1e-3f);
    EXPECT_NEAR(bodies[1].velocity.linear.x, 0.5f, 0.01f);
    EXPECT_NEAR(bodies[1].pose.position.x, 1.0f, 0.05f);
    EXPECT_NEAR(bodies[1].pose.position.y, 0.5f, 0.02f);
}

TEST_F(BulletPeer, resting_boxes_stay_awake_and_are_counted) {
    add_floor();
    for (int i = 0; i < 3; ++i)
        add(BodyKind::Rigid, Box{}, {0.0f, 0.5f + static_cast<float>(i), 0.0f});
    after(300);
    EXPECT_EQ(counts.manifolds, 3u);
    EXPECT_EQ(counts.contacts, 12u);
    EXPECT_GE(counts.pairs, 3u);
}

TEST_F(BulletPeer, both_engines_make_the_same_steps_from_the_same_start) {
    BenchOptions options;
    options.peer = k_bullet;
    options.simulation.steps = 120; // two whole blocks and a part of one
    options.simulation.threads = 1;
    const Measurement measured = measure({"pyramid:base=4", DeviceKind::Cpu}, options);
    ASSERT_TRUE(measured.peer.has_value());
    for (const Row* row : {&measured.talus, &*measured.peer}) {
        EXPECT_EQ(row->report.timing.steps, 120u);
        EXPECT_EQ(row->report.timing.step_ms.size(), 119u); // all but the first
        EXPECT_EQ(row->report.bodies.dynamic, 10u);
        EXPECT_EQ(row->report.quality.escaped_bodies, 0u);
        EXPECT_GT(row->report.quality.max_drift, 0.0);
        EXPECT_LT(row->report.quality.max_drift, 0.05) << row->runs_on;
        EXPECT_LT(row->report.quality.max_penetration, 0.05) << row->runs_on;
    }
    const Json line = to_json(*measured.peer);
    EXPECT_EQ(paths_of(to_json(measured.talus)).size(), paths_of(line).size());
    EXPECT_EQ(line["device"]["kind"], "bullet");
    EXPECT_EQ(line["device"]["name"], "Bullet");
    EXPECT_EQ(line["iterations"], 10);
    EXPECT_TRUE(line["memory_bytes"]["device"].is_null());
    EXPECT_TRUE(line["state_hash"].is_null());
}

class BenchPeer : public Bench {};

TEST_F(BenchPeer, is_measured_in_the_same_run_or_said_to_be_missing) {
    const Ending ending = bench("stack:height=2 pool:boxes=5 --steps 60 --peer bullet --json");
    if (!TALUS_HAS_BULLET) {
        EXPECT_EQ(ending.status, 2);
        EXPECT_TRUE(contains(ending.errors, "libbullet-dev")) << ending.errors;
        EXPECT_EQ(ending.output, "");
        return;
    }
    ASSERT_EQ(ending.status, 0) << ending.errors;
    EXPECT_TRUE(contains(ending.errors, "ratio"));
    const std::vector<json> lines = lines_of(ending.output);
    ASSERT_EQ(lines.size(), 4u);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i]["device"]["kind"], i % 2 == 0 ? "cpu" : "bullet");
        EXPECT_EQ(lines[i]["threads"], 1); // Talus as well, unless told otherwise
        EXPECT_EQ(lines[i]["scene"], lines[i - i % 2]["scene"]);
        EXPECT_EQ(lines[i]["steps"], 60);
    }
}

} // namespace
} // namespace talus::bench
