// SPDX-License-Identifier: MIT
// The program talus, run as a user runs it: exit status, what it prints, and the files it leaves.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <talus/recording.h>
#include <talus/world.h>

#include "program.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using talus::tests::Ending;
using talus::tests::keys_of;
using talus::tests::Program;

/// Runs that draw need OpenGL.
class ProgramPictures : public Program {};

TEST_F(Program, explains_itself) {
    const Ending help = talus("--help");
    EXPECT_EQ(help.status, 0);
    for (const char* command : {"demo", "run", "bench", "parity", "scenes", "devices", "./talus test"})
        EXPECT_NE(help.output.find(command), std::string::npos) << command;
    EXPECT_EQ(talus("run --help").status, 0);
    EXPECT_NE(talus("scenes").output.find("stack"), std::string::npos);
    EXPECT_NE(talus("devices").output.find("cpu"), std::string::npos);
}

TEST_F(Program, devices_tell_a_gpu_from_a_renderer_in_software) {
    const std::string list = talus("devices").output;
    for (std::size_t place = list.find("llvmpipe ("); place != std::string::npos;
         place = list.find("llvmpipe (", place + 1)) {
        const std::string line = list.substr(place, list.find('\n', place) - place);
        EXPECT_TRUE(line.ends_with(" (in software)")) << line;
    }
}

TEST_F(Program, bad_usage_ends_with_2_and_says_what_is_allowed) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "run"},
        {"", "./talus test"},
        {"fly", "fly"},
        {"run", "scene"},
        {"run stak", "stack"},
        {"run stack:height=nine", "height"},
        {"run none.glb", "none.glb"},
        {"run stack --steps -1", "--steps"},
        {"run stack --dt 0", "positive"},
        {"run stack --dt nan", "positive"},
        {"run stack --device tpu", "auto, gpu, cpu, hybrid"},
        {"run stack --broad-phase tree", "sap, bvh, brute"},
        {"run stack --stabilisation hard", "soft, baumgarte"},
        {"run stack --solve-order any", "coloured, sequential"},
        {"run stack --show wires", "contacts, normals, impulses, aabbs, pairs"},
        {"run stack --report none/report.json", "none/report.json"},
        {"run stack --record .", "folder"},
        {"run stack --state a.json --report ./a.json", "same file"},
        {"run stack --device cpu --video a.mp4 --width 321", "even"},
        {"run stack --image a.jpg", ".png"},
        {"run stack --image png", ".png"},
        {"run stack --video a.txt", ".mp4"},
        {"run stack --video a.mp4.gz", ".mp4"},
    };
    for (const auto& [arguments, expected] : cases) {
        const Ending ending = talus(arguments);
        EXPECT_EQ(ending.status, 2) << arguments;
        EXPECT_EQ(ending.output, "") << arguments;
        EXPECT_NE(ending.errors.find(expected), std::string::npos) << arguments << ": " << ending.errors;
        EXPECT_TRUE(folder_is_empty()) << arguments;
    }
}

TEST_F(Program, report_has_every_key) {
    const Ending ending = run_on_cpu("stack:height=3 --steps 20 --threads 2 --report report.json");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    EXPECT_EQ(ending.errors, "");
    const json report = json_of("report.json");
    EXPECT_EQ(keys_of(report),
              (std::vector<std::string>{
                  "bodies",  "broad_phase", "colours",          "contacts",      "device",    "dt",
                  "growths", "iterations",  "manifolds",        "memory_bytes",  "pairs",     "quality",
                  "scene",   "sleeping",    "solve_order",      "stabilisation", "stages_ms", "state_hash",
                  "step_ms", "steps",       "steps_per_second", "substeps",      "threads"}));
    EXPECT_EQ(keys_of(report["device"]), (std::vector<std::string>{"driver", "kind", "name"}));
    EXPECT_EQ(keys_of(report["bodies"]),
              (std::vector<std::string>{"dynamic", "kinematic", "sleeping", "static", "total"}));
    EXPECT_EQ(keys_of(report["step_ms"]), (std::vector<std::string>{"max", "mean", "median", "p95"}));
    EXPECT_EQ(keys_of(report["memory_bytes"]), (std::vector<std::string>{"device", "host"}));
    EXPECT_EQ(keys_of(report["quality"]),
              (std::vector<std::string>{"angular_momentum", "escaped_bodies", "kinetic_energy", "linear_momentum",
                                        "max_drift", "max_drift_sideways", "max_penetration", "max_speed",
                                        "mean_penetration", "nonfinite_bodies"}));
    for (const char* stage : talus::stage_names())
        EXPECT_TRUE(report["stages_ms"][stage].is_number()) << stage;

    EXPECT_EQ(report["scene"], "stack:height=3");
    EXPECT_EQ(report["device"]["kind"], "cpu");
    EXPECT_EQ(report["threads"], 2);
    EXPECT_EQ(report["steps"], 20);
    EXPECT_GE(report["substeps"], 8);
    EXPECT_EQ(report["bodies"]["dynamic"], 3);
    EXPECT_EQ(report["manifolds"], 3);
    EXPECT_EQ(report["contacts"], 12);
    EXPECT_GT(report["steps_per_second"], 0.0);
    EXPECT_LT(report["quality"]["max_penetration"], 0.02);
    EXPECT_LT(report["quality"]["max_drift"], 0.02);
    EXPECT_EQ(report["state_hash"].get<std::string>().size(), 16u);
}

TEST_F(Program, options_reach_the_solver) {
    ASSERT_EQ(run_on_cpu("stack --steps 3 --stabilisation baumgarte --broad-phase brute --solve-order sequential --dt "
                         "0.01 --report a.json "
                         "--quiet")
                  .status,
              0);
    const json report = json_of("a.json");
    EXPECT_EQ(report["stabilisation"], "baumgarte");
    EXPECT_EQ(report["iterations"], 10);
    EXPECT_EQ(report["broad_phase"], "brute");
    EXPECT_EQ(report["solve_order"], "sequential");
    EXPECT_EQ(report["dt"].get<float>(), 0.01f);
    ASSERT_EQ(run_on_cpu("stack --steps 3 --substeps 7 --iterations 2 --report b.json").status, 0);
    EXPECT_EQ(json_of("b.json")["substeps"], 7);
    EXPECT_EQ(json_of("b.json")["iterations"], 2);
}

TEST_F(Program, the_same_run_ends_in_the_same_bits) {
    ASSERT_EQ(run_on_cpu("pool:boxes=60 --steps 60 --threads 1 --report a.json --state a_state.json").status, 0);
    ASSERT_EQ(run_on_cpu("pool:boxes=60 --steps 60 --threads 3 --report b.json --state b_state.json").status, 0);
    EXPECT_EQ(json_of("a.json")["state_hash"], json_of("b.json")["state_hash"]);
    EXPECT_EQ(text_of(folder / "a_state.json"), text_of(folder / "b_state.json"));
}

TEST_F(Program, quiet_prints_nothing) {
    const Ending ending = run_on_cpu("stack --steps 2 --quiet");
    EXPECT_EQ(ending.status, 0);
    EXPECT_EQ(ending.output, "");
    EXPECT_EQ(ending.errors, "");
}

TEST_F(Program, reports_can_go_down_a_pipe) {
    const Ending ending = run_on_cpu("stack --steps 2 --quiet --report /dev/stdout | cat");
    EXPECT_EQ(json::parse(ending.output)["steps"], 2);
    EXPECT_TRUE(fs::is_symlink("/dev/stdout"));
}

TEST_F(Program, state_and_recording_agree) {
    const Ending ending = run_on_cpu("stack:height=4 --steps 30 --state state.json --record run.rec");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    const json state = json_of("state.json");
    ASSERT_EQ(state["bodies"].size(), 5u);

    talus::RecordingReader reader(folder / "run.rec");
    EXPECT_EQ(reader.header().scene, "stack:height=4");
    ASSERT_EQ(reader.frame_count(), 31u); // the start, and each step
    std::vector<talus::Pose> last;
    for (std::vector<talus::Pose> frame = reader.next(); !frame.empty(); frame = reader.next())
        last = frame;
    for (std::size_t i = 0; i < last.size(); ++i) {
        const json& body = state["bodies"][i];
        EXPECT_EQ(keys_of(body), (std::vector<std::string>{"angular_velocity", "kind", "linear_velocity", "name",
                                                           "position", "rotation", "sleeping"}));
        EXPECT_EQ(body["name"], reader.header().bodies[i].name);
        EXPECT_EQ(body["kind"], reader.header().bodies[i].kind == talus::BodyKind::Static ? "static" : "dynamic");
        EXPECT_EQ(body["position"][1].get<float>(), last[i].position.y);
        EXPECT_EQ(body["rotation"][3].get<float>(), last[i].rotation.w);
    }
}

TEST_F(Program, says_what_sleeps) {
    const Ending ending = run_on_cpu("stack:height=4 --steps 180 --sleeping --state state.json --report report.json");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    EXPECT_NE(ending.output.find("4 asleep"), std::string::npos) << ending.output;
    const json state = json_of("state.json"), report = json_of("report.json");
    for (const json& body : state["bodies"])
        EXPECT_EQ(body["sleeping"], body["kind"] == "dynamic") << body["name"];
    EXPECT_EQ(report["sleeping"], true);
    EXPECT_EQ(report["bodies"]["sleeping"], 4);
}

TEST_F(Program, an_interrupted_run_leaves_no_file) {
    const Ending ending = shell("timeout -s INT 1 '" TALUS_PROGRAM_FILE "' run --device cpu stack --steps 100000000 "
                                "--report report.json --record run.rec --quiet");
    EXPECT_TRUE(folder_is_empty());
    EXPECT_NE(ending.status, 0);
    EXPECT_NE(ending.errors.find("interrupted"), std::string::npos);
}

TEST_F(ProgramPictures, video_and_picture) {
    const Ending ending = run_on_cpu(
        "stack:height=3 --steps 30 --video v.mp4 --image i.png --width 320 --height 200 --show contacts,aabbs,pairs");
    ASSERT_EQ(ending.status, 0) << ending.errors;
    EXPECT_EQ(text_of(folder / "i.png").substr(1, 3), "PNG");
    EXPECT_EQ(text_of(folder / "v.mp4").substr(4, 4), "ftyp");
    EXPECT_NE(ending.output.find("v.mp4"), std::string::npos);
    // Half a second of video from its start on, and the picture of the end.
    const std::string note = "drawing 17 pictures of 320 × 200 pixels in software";
    EXPECT_EQ(ending.errors.find(note) != std::string::npos, talus::list_devices().front().in_software)
        << ending.errors;
    EXPECT_EQ(run_on_cpu("stack --steps 1 --image i.png --width 64 --height 48 --quiet").errors, "");
}

} // namespace
