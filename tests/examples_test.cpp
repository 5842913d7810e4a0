// SPDX-License-Identifier: MIT
// The programs of examples/ run, do what they say, and are short enough to be read in one go.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/devices.h"
#include "tests/shell.h"
#include "tests/text_of.h"

namespace talus::tests {
namespace {

namespace fs = std::filesystem;

const fs::path k_sources = TALUS_SOURCE_FOLDER "/examples";

std::size_t line_count(const fs::path& path) {
    const std::string text = text_of(path);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

class Examples : public testing::Test {
protected:
    Examples() { fs::create_directories(folder); }
    ~Examples() override { fs::remove_all(folder); }

    /// What an example prints; it runs in a folder of its own.
    std::string run(const std::string& example) const {
        const ShellEnding ending =
            run_in_shell("cd '" + folder.string() + "' && '" TALUS_EXAMPLES_FOLDER "/" + example + "'");
        EXPECT_EQ(ending.status, 0) << ending.output;
        return ending.output;
    }

    const fs::path folder = fs::path(testing::TempDir()) / ("talus_examples_" + std::to_string(getpid()));
};

TEST_F(Examples, are_short) {
    for (const fs::directory_entry& entry : fs::directory_iterator(k_sources)) {
        const bool renderer = entry.path().stem() == "own_renderer";
        EXPECT_LT(line_count(entry.path()), renderer ? 150u : 100u) << entry.path();
    }
}

TEST_F(Examples, are_run_here) {
    const std::string tests = text_of(__FILE__);
    for (const fs::directory_entry& entry : fs::directory_iterator(k_sources)) {
        if (entry.path().extension() != ".cpp") continue;
        EXPECT_NE(tests.find("run(\"" + entry.path().stem().string() + "\")"), std::string::npos) << entry.path();
    }
}

TEST_F(Examples, hello_world_bounces) {
    EXPECT_NE(run("hello_world").find("after 3 s: 0.50 m\n"), std::string::npos);
}

TEST_F(Examples, write_csv_has_the_slopes_of_the_textbook) {
    run("write_csv");
    std::istringstream file(text_of(folder / "slope.csv"));
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "time_s,degrees,distance_m,speed_m_per_s");
    int rows = 0;
    for (; std::getline(file, line); ++rows) {
        double time = 0.0, degrees = 0.0, distance = 0.0, speed = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &time, &degrees, &distance, &speed), 4) << line;
        const double angle = degrees * M_PI / 180.0;
        const double acceleration = std::max(0.0, 9.81 * (std::sin(angle) - 0.4 * std::cos(angle)));
        EXPECT_NEAR(distance, 0.5 * acceleration * time * time, 0.02 + 0.03 * distance) << line;
        EXPECT_NEAR(speed, acceleration * time, 0.02 + 0.01 * speed) << line;
    }
    EXPECT_EQ(rows, 8 * 20);
}

TEST_F(Examples, contact_events_counts_two_balls) {
    const std::string output = run("contact_events");
    EXPECT_NE(output.find("score 2"), std::string::npos) << output;
    EXPECT_EQ(output.find("score 3"), std::string::npos) << output;
    EXPECT_NE(output.find("thud of "), std::string::npos) << output;
}

TEST_F(Examples, debug_draw_draws_every_edge) {
    run("debug_draw");
    const std::string svg = text_of(folder / "debug_draw.svg");
    const auto count = [&](const std::string& part) {
        std::size_t found = 0;
        for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1))
            ++found;
        return found;
    };
    EXPECT_GE(count("<line "), 4u * 12u + 3u * 24u);
    EXPECT_EQ(count("<text "), 5u);
    EXPECT_GT(count("<circle "), 0u);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
}

class GlExamples : public Examples, public testing::WithParamInterface<DeviceKind> {
protected:
    void SetUp() override { TALUS_SKIP_WITHOUT(GetParam()); }
};

TEST_P(GlExamples, own_renderer_draws_what_talus_simulates) {
    EXPECT_NE(run("own_renderer").find("30 frames drawn on "), std::string::npos);
    const std::string picture = text_of(folder / "own_renderer.ppm"), head = "P6 640 360 255\n";
    ASSERT_TRUE(picture.starts_with(head));
    ASSERT_EQ(picture.size(), head.size() + 640 * 360 * 3);
    const auto pixel = [&](std::size_t x, std::size_t y) { return picture.substr(head.size() + 3 * (640 * y + x), 3); };
    std::set<std::string> colours;
    for (std::size_t y = 0; y < 360; ++y)
        for (std::size_t x = 0; x < 640; ++x)
            colours.insert(pixel(x, y));
    EXPECT_GT(colours.size(), 36u) << "a colour for each box, and sides in the light and in the shade";
    EXPECT_EQ(pixel(0, 0), pixel(639, 0)) << "sky";
    EXPECT_NE(pixel(320, 200), pixel(0, 0)) << "the pyramid";
    EXPECT_NE(pixel(320, 250), pixel(0, 0)) << "the ground";
}

TEST_P(GlExamples, second_thread_sees_the_ball_fall) {
    const std::string output = run("second_thread");
    int frames = 0;
    std::istringstream lines(output);
    for (std::string line; std::getline(lines, line); ++frames) {
        int frame = 0;
        double height = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "frame %d: %lf m", &frame, &height), 2) << line;
        const double time = frame / 60.0;
        EXPECT_NEAR(height, 10.0 - 0.5 * 9.81 * time * time, 0.02) << line;
    }
    EXPECT_EQ(frames, 3);
}

INSTANTIATE_TEST_SUITE_P(Devices, GlExamples, testing::Values(DeviceKind::Gpu),
                         [](const auto& test) { return name_of(test.param); });

} // namespace
} // namespace talus::tests
