// SPDX-License-Identifier: MIT
// The window as a user has it: on a screen of its own, driven by keys and mouse. What happened is read off the window's
// title, its pixels, and the snapshots that the user saves. Screenshots stay in the build folder, below
// pictures/window/.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "devices.h"
#include "program.h"
#include "render/picture.h"
#include "scenes/scene.h"
#include "x_window.h"

namespace talus::tests {
namespace {

namespace fs = std::filesystem;

constexpr int k_width = 900, k_height = 500; // of the window
constexpr int k_panel = 330;                 // pixels that the panels take
constexpr int k_middle_x = (k_panel + k_width) / 2, k_middle_y = k_height / 2;

struct Colour {
    int red = 0, green = 0, blue = 0;
};

Colour colour_at(const render::Picture& picture, int x, int y) {
    const std::size_t i = 3 * (static_cast<std::size_t>(y) * picture.width + static_cast<std::size_t>(x));
    return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

/// Pixels between two columns for which the condition holds.
template <typename Condition>
int count_between(int left, int right, const render::Picture& picture, const Condition& condition) {
    int count = 0;
    for (int y = 0; y < static_cast<int>(picture.height); ++y)
        for (int x = left; x < right; ++x)
            count += condition(colour_at(picture, x, y));
    return count;
}

/// Right of the panels.
template <typename Condition> int count_pixels(const render::Picture& picture, const Condition& condition) {
    return count_between(k_panel, static_cast<int>(picture.width), picture, condition);
}

bool is_green(const Colour& c) {
    return c.green > c.red + 20 && c.green > c.blue + 20;
}
bool is_pink(const Colour& c) {
    return c.red > 200 && c.green < 140 && c.blue > 120;
}
bool is_red(const Colour& c) {
    return c.red > c.green + 60 && c.red > c.blue + 60;
}

/// The number after a word of the title: "... - step 12 - ...".
std::uint64_t step_in(const std::string& title) {
    const std::size_t place = title.find("step ");
    return place == std::string::npos ? 0 : std::stoull(title.substr(place + 5));
}

class WindowOnScreen : public Program {
protected:
    void SetUp() override {
        if (XWindow::is_possible()) return;
        std::cerr << "NO XVFB, THE WINDOW IS NOT TESTED\n";
        GTEST_SKIP();
    }

    /// On the CPU, with its first step still to come.
    XWindow& open(const std::string& scene, int width = k_width, int height = k_height, int dots_per_inch = 96) {
        const std::vector<std::string> command{TALUS_PROGRAM_FILE,
                                               "view",
                                               scene,
                                               "--paused",
                                               "--device=cpu",
                                               "--threads=1",
                                               "--width",
                                               std::to_string(width),
                                               "--height",
                                               std::to_string(height)};
        opened.emplace(command, folder, dots_per_inch);
        return *opened;
    }

    bool shows(const std::string& part) const {
        return opened->wait_for_title([&](const std::string& t) { return t.find(part) != std::string::npos; });
    }
    bool reaches_step(std::uint64_t step) const {
        return opened->wait_for_title([&](const std::string& title) { return step_in(title) >= step; });
    }
    /// Waits until a file is there.
    bool appears(const std::string& name) const {
        for (int i = 0; i < 2000 && !fs::exists(folder / name); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return fs::exists(folder / name);
    }
    /// Saves a snapshot with F5, and gives a world that it was loaded into.
    World saved_world() {
        const std::string scene = opened->title().substr(7);
        const std::string name =
            scene.substr(0, scene.find_first_of(": ")) + "-" + std::to_string(++saved) + ".snapshot";
        opened->press("F5");
        EXPECT_TRUE(appears(name)) << name;
        World world({}, options_on(DeviceKind::Cpu));
        world.restore(Snapshot::load(folder / name));
        return world;
    }
    render::Picture look(const std::string& name) const {
        std::this_thread::sleep_for(std::chrono::milliseconds(700)); // some frames
        render::Picture picture = opened->look();
        fs::create_directories(TALUS_PICTURES_FOLDER);
        render::write_png(fs::path(TALUS_PICTURES_FOLDER) / (name + ".png"), picture);
        return picture;
    }

    std::optional<XWindow> opened;
    int saved = 0;
};

BodyId find(const World& world, BodyKind kind) {
    for (const BodyId id : world.bodies())
        if (world.kind(id) == kind) return id;
    ADD_FAILURE() << "no such body";
    return {};
}

} // namespace

TEST_F(WindowOnScreen, runs_pauses_steps_and_steps_back_to_the_same_bits) {
    XWindow& window = open("stack:height=4");
    ASSERT_TRUE(shows("Talus: stack:height=4 - step 0 - paused - cpu - 5 bodies"));
    const render::Picture start = look("start");
    EXPECT_TRUE(is_green(colour_at(start, k_middle_x, k_middle_y)));

    for (const char* step : {"step 1 ", "step 2 ", "step 3 "}) {
        window.press("period");
        ASSERT_TRUE(shows(step));
    }
    const std::uint64_t third = saved_world().state_hash();
    window.press("comma");
    ASSERT_TRUE(shows("step 2 "));
    EXPECT_NE(saved_world().state_hash(), third);
    window.press("period");
    ASSERT_TRUE(shows("step 3 "));
    EXPECT_EQ(saved_world().state_hash(), third);

    window.click(81, 56); // the panel's button "Step"
    EXPECT_TRUE(shows("step 4 "));

    window.press("space");
    ASSERT_TRUE(shows("running"));
    ASSERT_TRUE(reaches_step(30));
    window.press("space");
    ASSERT_TRUE(shows("paused"));
    const render::Picture graphs = look("graphs");
    const auto is_turquoise = [](const Colour& c) { return c.blue > 200 && c.green > 150 && c.red < 60; };
    EXPECT_GT(count_between(0, k_panel, graphs, is_turquoise), 150) << "the time of the stage solve";
    // What a run without a window gives.
    World shown = saved_world();
    World plain({}, options_on(DeviceKind::Cpu));
    for (const scenes::NamedBody& body : scenes::make_scene("stack:height=4").bodies)
        plain.add(body.definition);
    plain.step(static_cast<std::uint32_t>(shown.step_count()));
    EXPECT_EQ(plain.state_hash(), shown.state_hash());

    window.press("r");
    EXPECT_TRUE(shows("step 0 "));
    window.press("Control_L+q");
    EXPECT_EQ(window.wait_for_end(), 0);
}

TEST_F(WindowOnScreen, drags_a_body_with_the_mouse) {
    XWindow& window = open("stack:height=1");
    ASSERT_TRUE(shows("step 0 "));
    window.move_mouse(k_middle_x, k_middle_y);
    window.hold_button(1, true);
    window.press("space");
    ASSERT_TRUE(reaches_step(5));
    for (int i = 1; i <= 10; ++i)
        window.move_mouse(k_middle_x, k_middle_y - 20 * i);
    ASSERT_TRUE(reaches_step(step_in(window.title()) + 90));
    look("dragged");
    const World held = saved_world();
    const float height = held.pose(find(held, BodyKind::Rigid)).position.y;
    EXPECT_GT(height, 0.8f); // it lay at 0.5 m
    window.hold_button(1, false);
    ASSERT_TRUE(reaches_step(step_in(window.title()) + 90));
    const World fallen = saved_world();
    EXPECT_LT(fallen.pose(find(fallen, BodyKind::Rigid)).position.y, height - 0.2f);
}

TEST_F(WindowOnScreen, shoots_drops_removes_and_drives) {
    XWindow& window = open("stack:height=3");
    ASSERT_TRUE(shows("4 bodies"));
    window.move_mouse(k_middle_x, k_middle_y);
    window.press("b");
    ASSERT_TRUE(shows("5 bodies"));
    window.press("x");
    ASSERT_TRUE(shows("6 bodies"));
    {
        const World world = saved_world();
        const auto bodies = world.bodies();
        EXPECT_TRUE(std::holds_alternative<Sphere>(world.shape(bodies[4])));
        EXPECT_GT(world.pose(bodies[5]).position.y, world.pose(bodies[3]).position.y); // above what the mouse is on
    }
    window.press("Delete");
    ASSERT_TRUE(shows("5 bodies"));
    window.press("k");
    ASSERT_TRUE(shows("6 bodies"));
    window.move_mouse(k_middle_x + 120, k_middle_y + 120);
    window.press("k"); // the newest is driven
    ASSERT_TRUE(shows("7 bodies"));
    const World before = saved_world();
    window.hold("Right", true);
    window.press("space");
    ASSERT_TRUE(reaches_step(60));
    look("thrown");
    window.hold("Right", false);
    const World after = saved_world();
    const BodyId first = find(before, BodyKind::Kinematic), driven = before.bodies().back();
    ASSERT_EQ(before.kind(driven), BodyKind::Kinematic);
    ASSERT_NE(driven, first);
    const Vec3 from = before.pose(driven).position, to = after.pose(driven).position;
    EXPECT_GT(std::hypot(to.x - from.x, to.z - from.z), 1.0f);
    EXPECT_EQ(to.y, from.y);
    EXPECT_EQ(after.pose(first).position, before.pose(first).position);
    window.press("r");
    EXPECT_TRUE(shows("4 bodies"));
}

TEST_F(WindowOnScreen, goes_on_on_another_device_with_the_same_bits) {
    TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
    XWindow& window = open("pyramid:base=4");
    ASSERT_TRUE(shows("step 0 "));
    int step = 0;
    for (const char* device : {"hybrid", "gpu", "cpu"}) {
        for (int i = 0; i < 3; ++i) {
            window.press("period");
            ASSERT_TRUE(shows("step " + std::to_string(++step) + " "));
        }
        window.press("g");
        ASSERT_TRUE(shows(std::string(" - ") + device + " - ")) << window.title();
        look(std::string("on the ") + device);
    }
    const World shown = saved_world();
    EXPECT_EQ(shown.step_count(), 9u);
    World plain({}, options_on(DeviceKind::Cpu));
    for (const scenes::NamedBody& body : scenes::make_scene("pyramid:base=4").bodies)
        plain.add(body.definition);
    plain.step(9);
    EXPECT_EQ(plain.state_hash(), shown.state_hash());
    // The past goes along.
    window.press("comma");
    EXPECT_TRUE(shows("step 8 "));
}

TEST_F(WindowOnScreen, opens_scenes_and_files) {
    XWindow& window = open("pool:boxes=5,seed=7");
    ASSERT_TRUE(shows("seed=7"));
    window.press("n");
    EXPECT_TRUE(window.wait_for_title([](const std::string& t) { return t.find("seed=7 ") == std::string::npos; }));

    std::ofstream(folder / "tower.gltf") << R"({"asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_implicit_shapes", "KHR_physics_rigid_bodies"],
        "extensions": {"KHR_implicit_shapes": {"shapes": [{"type": "box", "box": {"size": [1, 1, 1]}}]}},
        "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "box", "translation": [0, 3, 0], "extensions": {"KHR_physics_rigid_bodies":
            {"motion": {}, "collider": {"geometry": {"shape": 0}}}}}]})";
    window.drop_file(folder / "tower.gltf");
    EXPECT_TRUE(shows("tower.gltf")) << window.title();
    EXPECT_TRUE(shows("1 bodies"));

    // What cannot be opened is said, and the scene stays as it is.
    std::ofstream(folder / "broken.gltf") << "{";
    window.drop_file(folder / "broken.gltf");
    const render::Picture told = look("broken file");
    EXPECT_LT(colour_at(told, k_width - 40, k_height - 25).red, 80); // the message's dark ground
    EXPECT_NE(window.title().find("tower.gltf"), std::string::npos);

    // By the panel "Scenes", its search, and Enter. Letters that are typed there are no commands.
    window.click(100, 150 + 16); // the file's name above takes two lines
    window.click(100, 175 + 16);
    for (const char* letter : {"d", "o", "m", "i", "n"})
        window.press(letter);
    look("search");
    window.press("Return");
    EXPECT_TRUE(shows("dominoes:count=100")) << window.title();
    EXPECT_TRUE(shows("step 0 - paused"));

    // A snapshot of another scene.
    World world({}, options_on(DeviceKind::Cpu));
    for (const scenes::NamedBody& body : scenes::make_scene("stack:height=6").bodies)
        world.add(body.definition);
    world.step(12);
    world.snapshot().save(folder / "other.snapshot");
    window.drop_file(folder / "other.snapshot");
    EXPECT_TRUE(shows("other.snapshot - step 12 "));
    EXPECT_TRUE(shows("7 bodies"));
    EXPECT_GT(count_pixels(look("dropped snapshot"), is_green), 2000);
}

TEST_F(WindowOnScreen, shows_overlays_panels_and_help) {
    XWindow& window = open("stack:height=3");
    ASSERT_TRUE(shows("step 0 "));
    window.press("period");
    window.press("period");
    ASSERT_TRUE(shows("step 2 "));
    const render::Picture plain = look("plain");
    EXPECT_EQ(count_pixels(plain, is_pink), 0);
    EXPECT_EQ(count_pixels(plain, is_red), 0);
    window.press("1");
    window.press("2");
    EXPECT_GT(count_pixels(look("contacts and normals"), is_pink), 50);
    window.press("1");
    window.press("2");
    window.press("5");
    EXPECT_GT(count_pixels(look("pairs"), is_red), 500);
    window.press("5");
    window.press("9");
    EXPECT_LT(count_pixels(look("wireframe"), is_green), count_pixels(plain, is_green) / 2);
    window.press("9");
    for (const char* key : {"3", "4", "6", "7", "8", "0"})
        window.press(key);
    const render::Picture all = look("impulses, boxes, colours, islands, velocities, transparent");
    EXPECT_NE(all.rgb, plain.rgb);

    window.press("F1");
    const render::Picture help = look("help");
    EXPECT_LT(colour_at(help, k_middle_x, k_middle_y + 100).green, 90); // dark where the scene was
    window.press("Escape");
    window.press("Tab");
    const render::Picture bare = look("without panels");
    EXPECT_GT(colour_at(bare, 20, 20).green, 120); // the sky where the panels were
}

TEST_F(WindowOnScreen, turns_and_moves_the_camera) {
    XWindow& window = open("stack:height=3");
    ASSERT_TRUE(shows("step 0 "));
    render::Picture before = look("camera");
    const auto changes = [&](const std::string& name) {
        render::Picture now = look("camera " + name);
        bool changed = false;
        for (int y = 0; y < k_height; ++y)
            for (int x = k_panel; x < k_width; ++x)
                changed |= colour_at(now, x, y).green != colour_at(before, x, y).green;
        before = std::move(now);
        return changed;
    };
    window.move_mouse(k_middle_x, k_middle_y);
    EXPECT_FALSE(changes("untouched"));
    window.hold_button(3, true);
    window.move_mouse(k_middle_x + 120, k_middle_y + 30);
    window.hold_button(3, false);
    EXPECT_TRUE(changes("turned"));
    window.turn_wheel(-4);
    EXPECT_TRUE(changes("farther"));
    window.hold_button(2, true);
    window.move_mouse(k_middle_x + 60, k_middle_y);
    window.hold_button(2, false);
    EXPECT_TRUE(changes("sideways"));
    window.press("c");
    window.hold("w", true);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    window.hold("w", false);
    EXPECT_TRUE(changes("flown"));
    EXPECT_EQ(step_in(window.title()), 0u);
}

TEST_F(WindowOnScreen, saves_pictures_and_videos) {
    XWindow& window = open("stack:height=2");
    ASSERT_TRUE(shows("step 0 "));
    window.press("F2");
    ASSERT_TRUE(appears("stack-1.png"));
    window.press("F3");
    window.press("space");
    ASSERT_TRUE(reaches_step(20)); // ten pictures: each is shown for 1/30 s
    window.press("space");
    ASSERT_TRUE(shows("paused"));
    window.press("F3");
    ASSERT_TRUE(appears("stack-1.mp4"));
    const Ending probe = shell("ffprobe -v error -count_frames -select_streams v -show_entries "
                               "stream=width,height,nb_read_frames -of csv=p=0 stack-1.mp4");
    EXPECT_EQ(probe.status, 0) << probe.errors;
    int width = 0, height = 0, frames = 0;
    ASSERT_EQ(std::sscanf(probe.output.c_str(), "%d,%d,%d", &width, &height, &frames), 3) << probe.output;
    EXPECT_EQ(width, k_width - k_panel);
    EXPECT_EQ(height, k_height);
    EXPECT_GE(frames, 8);
    EXPECT_NEAR(2.0 * frames, static_cast<double>(step_in(window.title())), 3.0);
}

TEST_F(WindowOnScreen, closes_after_so_long_and_tells_the_frame_rate) {
    const Ending ending = shell("xvfb-run -a '" TALUS_PROGRAM_FILE "' view stack:height=2 --device cpu --seconds 1");
    EXPECT_EQ(ending.status, 0) << ending.errors;
    int frames = 0;
    double seconds = 0.0, rate = 0.0;
    ASSERT_EQ(std::sscanf(ending.output.c_str(), "%d frames in %lf s: %lf frames/s", &frames, &seconds, &rate), 3)
        << ending.output;
    EXPECT_GE(seconds, 1.0);
    EXPECT_NEAR(rate * seconds, frames, 0.1 * frames + 1.0);
}

TEST_F(WindowOnScreen, is_larger_on_a_hidpi_screen) {
    open("stack:height=2", 600, 400, 192);
    ASSERT_TRUE(shows("step 0 "));
    const render::Picture picture = look("hidpi");
    EXPECT_EQ(picture.width, 1200u);
    EXPECT_EQ(picture.height, 800u);
    EXPECT_LT(colour_at(picture, 2 * k_panel - 20, 700).blue, 90) << "the panels are twice as wide";
}

TEST_F(WindowOnScreen, shows_the_picture_of_the_documents) {
    XWindow& window = open("pool:boxes=150", 1280, 720);
    ASSERT_TRUE(shows("step 0 "));
    window.press("space");
    ASSERT_TRUE(reaches_step(80));
    window.move_mouse(800, 380);
    window.press("x");
    window.press("1");
    window.press("3");
    ASSERT_TRUE(reaches_step(100));
    window.press("space");
    ASSERT_TRUE(shows("paused"));
    const render::Picture picture = look("view");
    EXPECT_GT(count_pixels(picture, is_green), 20000);
    EXPECT_GT(count_pixels(picture, is_pink), 100);
}

// ---- without a screen ----

using WindowWithoutScreen = Program;

TEST_F(WindowWithoutScreen, says_how_to_do_without) {
    for (const char* display : {"", "DISPLAY=:654", "DISPLAY=nonsense"}) {
        const Ending ending =
            shell(std::string("unset DISPLAY WAYLAND_DISPLAY; ") +
                  (*display != '\0' ? std::string("export ") + display + "; " : "") + "talus view stack");
        EXPECT_EQ(ending.status, 2) << display;
        EXPECT_NE(ending.errors.find("window"), std::string::npos) << ending.errors;
        EXPECT_NE(ending.errors.find("`talus run SCENE --video FILE.mp4`"), std::string::npos) << ending.errors;
    }
}

TEST_F(WindowWithoutScreen, tells_how_fast_its_pictures_can_be_made) {
    const Ending ending = shell("unset DISPLAY WAYLAND_DISPLAY; talus view stack:height=2 --offscreen --device cpu "
                                "--seconds 0.5 --width 320 --height 180");
    EXPECT_EQ(ending.status, 0) << ending.errors;
    EXPECT_TRUE(ending.output.starts_with("3 bodies, 320 × 180 pixels, ")) << ending.output;
    int frames = 0;
    double seconds = 0.0, rate = 0.0, work = 0.0, played = 0.0;
    ASSERT_EQ(std::sscanf(ending.output.c_str() + ending.output.find('\n'),
                          " %d frames in %lf s: %lf frames/s, %lf ms of work a frame, %lf", &frames, &seconds, &rate,
                          &work, &played),
              5)
        << ending.output;
    EXPECT_GE(seconds, 0.5);
    EXPECT_NEAR(played, rate / 60.0, 0.02) << "a step of 1/60 s each";
    EXPECT_NE(ending.output.find("longest"), std::string::npos);
    EXPECT_TRUE(folder_is_empty());
}

TEST_F(WindowWithoutScreen, bad_usage_ends_with_2) {
    EXPECT_EQ(talus("view stack --width 0").status, 2);
    EXPECT_EQ(talus("view stack --show wires").status, 2);
    EXPECT_EQ(talus("view stack stack").status, 2);
}

} // namespace talus::tests
