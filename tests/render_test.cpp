// SPDX-License-Identifier: MIT
// Pictures and videos: what is where in a picture, in which colour, the same from both devices; files that are whole or
// not there at all.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include "render/overlay_lines.h"
#include "render/renderer.h"
#include "render/video_writer.h"
#include "tests/environment.h"

namespace talus::render {
namespace {

using tests::Variable;

constexpr std::uint32_t k_width = 160, k_height = 120;

struct Colour {
    int red = 0, green = 0, blue = 0;
};

Colour colour_at(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    const std::size_t i = 3 * (std::size_t{y} * picture.width + x);
    return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

Colour middle_of(const Picture& picture) {
    // Beside the exact middle, where a sphere's rings meet.
    return colour_at(picture, picture.width / 2 + 4, picture.height / 2 - 4);
}

bool is_green(const Colour& c) {
    return c.green > c.red + 20 && c.green > c.blue + 20;
}
bool is_blue(const Colour& c) {
    return c.blue > c.red + 20 && c.blue > c.green + 20;
}
bool is_orange(const Colour& c) {
    return c.red > c.green + 20 && c.green > c.blue + 20;
}
bool is_red(const Colour& c) {
    return c.red > c.green + 60 && c.red > c.blue + 60;
}
bool is_pink(const Colour& c) {
    return c.red > c.green + 60 && c.blue > c.green + 20;
}
bool is_background(const Colour& c) {
    return c.red > 180 && c.green > 180 && c.blue >= c.red;
}

std::size_t count(const Picture& picture, bool (*matches)(const Colour&)) {
    std::size_t found = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x)
            found += matches(colour_at(picture, x, y)) ? 1 : 0;
    }
    return found;
}

const scenes::Camera k_camera{{3.0f, 2.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.7f};

BodyDefinition body_at(const Vec3& position, BodyKind kind = BodyKind::Rigid, const Shape& shape = Box{}) {
    BodyDefinition definition;
    definition.kind = kind;
    definition.shape = shape;
    definition.pose.position = position;
    return definition;
}

WorldOptions on(DeviceKind device) {
    WorldOptions options;
    options.device = device;
    options.wait_for_kernels = true;
    return options;
}

std::string error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A folder of its own for each test.
class Files : public testing::Test {
protected:
    Files() : folder(std::filesystem::temp_directory_path() / ("talus_render_test_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder);
    }
    ~Files() override { std::filesystem::remove_all(folder); }

    std::size_t file_count() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
    }

    std::filesystem::path folder;
};

Picture gradient(std::uint32_t width, std::uint32_t height, int shift = 0) {
    Picture picture{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            for (const std::uint32_t value : {x + static_cast<std::uint32_t>(shift), y, x + y})
                picture.rgb.push_back(static_cast<std::uint8_t>(value));
        }
    }
    return picture;
}

TEST(Renderer, shows_each_kind_of_body_in_its_colour) {
    const std::array<std::pair<BodyKind, bool (*)(const Colour&)>, 3> expected{
        {{BodyKind::Static, is_blue}, {BodyKind::Rigid, is_green}, {BodyKind::Kinematic, is_orange}}};
    for (const Shape& shape : {Shape(Box{}), Shape(Sphere{})}) {
        for (const auto& [kind, has_its_colour] : expected) {
            World world({}, on(DeviceKind::Cpu));
            world.add(body_at({}, kind, shape));
            const Picture picture = Renderer(world, k_width, k_height, k_camera).draw();
            EXPECT_TRUE(has_its_colour(middle_of(picture)));
            EXPECT_TRUE(is_background(colour_at(picture, 2, 2)));
            EXPECT_TRUE(is_background(colour_at(picture, k_width - 3, 2)));
        }
    }
}

TEST(Renderer, follows_bodies_that_move_come_and_go) {
    World world({}, on(DeviceKind::Cpu));
    Renderer renderer(world, k_width, k_height, k_camera);
    EXPECT_TRUE(is_background(middle_of(renderer.draw())));
    const BodyId first = world.add(body_at({}));
    EXPECT_TRUE(is_green(middle_of(renderer.draw())));
    world.set_pose(first, {{50.0f, 0.0f, 0.0f}, {}});
    EXPECT_TRUE(is_background(middle_of(renderer.draw())));
    world.remove(first);
    world.add(body_at({}, BodyKind::Kinematic, Sphere{}));
    EXPECT_TRUE(is_orange(middle_of(renderer.draw())));
}

TEST(Renderer, throws_a_shadow_away_from_the_sun) {
    World world({}, on(DeviceKind::Cpu));
    world.add(body_at({0.0f, -1.0f, 0.0f}, BodyKind::Static, Box{{6.0f, 0.2f, 6.0f}}));
    Renderer renderer(world, k_width, k_height, k_camera);
    const Picture before = renderer.draw();
    world.add(body_at({0.0f, 0.5f, 0.0f}));
    const Picture after = renderer.draw();
    std::size_t darker = 0;
    for (std::uint32_t y = 0; y < k_height; ++y) {
        for (std::uint32_t x = 0; x < k_width; ++x) {
            const Colour lit = colour_at(before, x, y), now = colour_at(after, x, y);
            darker += is_blue(now) && now.blue + 30 < lit.blue ? 1 : 0;
        }
    }
    EXPECT_GT(darker, 100u);
}

TEST(Renderer, shows_pairs_contacts_and_bounding_boxes_where_asked_for) {
    World world({}, on(DeviceKind::Cpu));
    world.add(body_at({0.0f, -0.6f, 0.0f}, BodyKind::Static, Box{{4.0f, 0.2f, 4.0f}}));
    world.add(body_at({}));
    world.step();
    ASSERT_FALSE(world.contacts().empty());
    const Picture plain = Renderer(world, k_width, k_height, k_camera).draw();
    EXPECT_EQ(count(plain, is_red), 0u);
    EXPECT_EQ(count(plain, is_pink), 0u);
    const Picture pairs = Renderer(world, k_width, k_height, k_camera, {.pairs = true}).draw();
    EXPECT_GT(count(pairs, is_red), 500u);
    EXPECT_GT(count(pairs, is_blue), 500u) << "static bodies keep their colour";
    EXPECT_GT(count(Renderer(world, k_width, k_height, k_camera, {.contacts = true}).draw(), is_pink), 20u);
    EXPECT_NE(Renderer(world, k_width, k_height, k_camera, {.aabbs = true}).draw().rgb, plain.rgb);
}

TEST(Renderer, shows_normals_impulses_and_the_constraint_graph_as_lines) {
    World world({}, on(DeviceKind::Cpu));
    world.add(body_at({0.0f, -0.6f, 0.0f}, BodyKind::Static, Box{{4.0f, 0.2f, 4.0f}}));
    world.add(body_at({}));
    world.step(3);
    const Picture plain = Renderer(world, k_width, k_height, k_camera).draw();
    EXPECT_GT(count(Renderer(world, k_width, k_height, k_camera, {.normals = true}).draw(), is_pink), 10u);
    const auto is_yellow = [](const Colour& c) { return c.red > c.blue + 80 && c.green > c.blue + 60; };
    EXPECT_EQ(count(plain, is_yellow), 0u);
    EXPECT_GT(count(Renderer(world, k_width, k_height, k_camera, {.impulses = true}).draw(), is_yellow), 20u);
    EXPECT_NE(Renderer(world, k_width, k_height, k_camera, {.colours = true}).draw().rgb, plain.rgb);
    const auto dark_blue = [](const Colour& c) { return c.blue > 180 && c.red < 80 && c.green < 130; };
    world.set_velocity(world.bodies()[1], {{4.0f, 0.0f, 0.0f}, {}});
    EXPECT_GT(count(Renderer(world, k_width, k_height, k_camera, {.velocities = true}).draw(), dark_blue), 10u);
}

TEST(Renderer, shows_islands_each_in_a_colour) {
    World world({}, on(DeviceKind::Cpu));
    for (const float x : {-0.8f, 0.8f})
        for (const float y : {-0.5f, 0.5f})
            world.add(body_at({x, y, 0.0f}));
    world.add(body_at({0.0f, 0.0f, -3.0f})); // touches nothing
    world.step();
    ASSERT_EQ(world.contacts().size(), 2u);
    const scenes::Camera ahead{{0.0f, 0.0f, 6.0f}, {0.0f, 0.0f, 0.0f}, 0.7f};
    const Picture picture = Renderer(world, k_width, k_height, ahead, {.islands = true}).draw();
    const auto at = [&](std::uint32_t x, std::uint32_t y) { return colour_at(picture, x, y); };
    const auto apart = [](const Colour& a, const Colour& b) {
        return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue);
    };
    const Colour left = at(58, 45), below = at(58, 75), right = at(102, 45);
    EXPECT_LT(apart(left, below), 60);
    EXPECT_GT(apart(left, right), 100);
    EXPECT_TRUE(is_green(at(80, 60))) << "a body alone keeps its colour";
}

TEST(Renderer, shows_through_sensors_which_throw_no_shadow) {
    for (const Shape& shape : {Shape(Box{}), Shape(Sphere{})}) {
        World world({}, on(DeviceKind::Cpu));
        world.add(body_at({0.0f, -1.0f, 0.0f}, BodyKind::Static, Box{{6.0f, 0.2f, 6.0f}}));
        const Picture ground = Renderer(world, k_width, k_height, k_camera).draw();
        const auto darker_than_ground = [&](const Picture& picture) {
            std::size_t darker = 0;
            for (std::uint32_t y = 0; y < k_height; ++y)
                for (std::uint32_t x = 0; x < k_width; ++x) {
                    const Colour now = colour_at(picture, x, y);
                    darker += is_blue(now) && now.blue + 50 < colour_at(ground, x, y).blue ? 1 : 0;
                }
            return darker;
        };
        const BodyId body = world.add(body_at({0.0f, 0.5f, 0.0f}, BodyKind::Rigid, shape));
        EXPECT_GT(darker_than_ground(Renderer(world, k_width, k_height, k_camera).draw()), 100u);
        world.set_sensor(body, true);
        const Picture sensor = Renderer(world, k_width, k_height, k_camera).draw();
        EXPECT_LT(darker_than_ground(sensor), 40u); // its edges
        EXPECT_EQ(count(sensor, is_green), 0u);
        std::size_t changed = 0, much = 0;
        for (std::size_t i = 2; i < sensor.rgb.size(); i += 3) {
            changed += sensor.rgb[i] != ground.rgb[i] ? 1 : 0;
            much += std::abs(sensor.rgb[i] - ground.rgb[i]) > 60 ? 1 : 0;
        }
        EXPECT_GT(changed, 500u) << "its faces";
        EXPECT_GT(much, 30u) << "its edges";
        EXPECT_LT(much, changed / 3);
    }
}

TEST(Renderer, sensors_are_in_no_island_and_no_batch) {
    World world({}, on(DeviceKind::Cpu));
    BodyDefinition zone = body_at({}, BodyKind::Rigid, Box{{2.0f, 2.0f, 2.0f}});
    zone.sensor = true;
    world.add(zone);
    world.add(body_at({-0.9f, 0.0f, 0.0f}));
    world.add(body_at({0.9f, 0.0f, 0.0f}));
    world.step();
    const std::vector<Contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 2u);
    const std::vector<std::uint32_t> tints = tints_of(world, contacts, {.islands = true}, 3);
    EXPECT_EQ(tints, (std::vector<std::uint32_t>{0, 0, 0}));
    std::vector<Line> lines;
    add_contact_lines(lines, world, contacts, {.colours = true}, 1.0f);
    EXPECT_TRUE(lines.empty());
}

TEST(Renderer, shows_islands_that_sleep_in_grey) {
    Settings settings;
    settings.gravity = {};
    settings.sleeping = true;
    World world(settings, on(DeviceKind::Cpu));
    for (const float x : {-0.8f, 0.8f})
        world.add(body_at({x, 0.0f, 0.0f}));
    world.step(60);
    world.wake(world.bodies()[1]);
    world.step();
    const scenes::Camera ahead{{0.0f, 0.0f, 6.0f}, {0.0f, 0.0f, 0.0f}, 0.7f};
    const Picture picture = Renderer(world, k_width, k_height, ahead, {.islands = true}).draw();
    const Colour asleep = colour_at(picture, 58, 60), awake = colour_at(picture, 102, 60);
    EXPECT_LT(std::abs(asleep.red - asleep.green) + std::abs(asleep.green - asleep.blue), 60);
    EXPECT_TRUE(is_green(awake));
}

TEST(Renderer, shows_what_is_behind_and_within) {
    World world({}, on(DeviceKind::Cpu));
    world.add(body_at({0.0f, 0.0f, -1.0f}));
    const scenes::Camera ahead{{0.0f, 0.0f, 6.0f}, {0.0f, 0.0f, 0.0f}, 0.7f};
    const auto draw = [&](const Overlays& overlays) {
        return Renderer(world, k_width, k_height, ahead, overlays).draw();
    };
    const std::size_t whole = count(draw({}), is_green);
    const std::size_t wires = count(draw({.wireframe = true}), is_green);
    EXPECT_GT(whole, 400u);
    EXPECT_GT(wires, 20u);
    EXPECT_LT(wires, whole * 2 / 3) << "faces are not drawn";

    world.add(body_at({0.0f, 0.0f, 1.5f}, BodyKind::Static, Box{{3.0f, 3.0f, 0.1f}}));
    const auto box_behind_wall = [&](const Overlays& overlays) {
        const Picture picture = draw(overlays);
        const Colour middle = colour_at(picture, 84, 56), wall = colour_at(picture, 45, 60);
        return std::abs(middle.red - wall.red) + std::abs(middle.green - wall.green) +
               std::abs(middle.blue - wall.blue);
    };
    EXPECT_LT(box_behind_wall({}), 10);
    EXPECT_GT(box_behind_wall({.transparent = true}), 60);
}

TEST(Renderer, gives_the_same_picture_from_both_devices) {
    std::array<std::optional<Picture>, 2> pictures;
    for (const std::size_t i : {0u, 1u}) {
        std::optional<World> world;
        try {
            world.emplace(Settings{}, on(i == 0 ? DeviceKind::Cpu : DeviceKind::Gpu));
        } catch (const Error& error) {
            std::cerr << "NO OPENGL 4.5 CONTEXT, NOT TESTED: " << error.what() << "\n";
            GTEST_SKIP();
        }
        world->add(body_at({0.0f, -0.6f, 0.0f}, BodyKind::Static, Box{{4.0f, 0.2f, 4.0f}}));
        world->remove(world->add(body_at({0.5f, 0.5f, 0.5f})));
        world->add(body_at({0.0f, 0.2f, 0.0f}));
        world->add(body_at({1.0f, 0.1f, 0.5f}, BodyKind::Kinematic, Sphere{0.3f}));
        Renderer renderer(*world, k_width, k_height, k_camera);
        world->step();
        pictures[i] = renderer.draw();
        world->step(); // the renderer must leave nothing behind that a step stumbles over
        EXPECT_EQ(world->report().step, 2u);
    }
    std::size_t different = 0;
    for (std::size_t i = 0; i < pictures[0]->rgb.size(); ++i)
        different += std::abs(pictures[0]->rgb[i] - pictures[1]->rgb[i]) > 4 ? 1 : 0;
    EXPECT_LT(different, pictures[0]->rgb.size() / 1000);
}

TEST(Renderer, gives_pending_pictures_in_order) {
    World world({}, on(DeviceKind::Cpu));
    const BodyId body = world.add(body_at({}));
    Renderer renderer(world, k_width, k_height, k_camera);
    renderer.submit();
    world.set_pose(body, {{50.0f, 0.0f, 0.0f}, {}});
    renderer.submit();
    renderer.submit();
    EXPECT_EQ(renderer.pending(), Renderer::k_most_pending);
    EXPECT_TRUE(contains(error_of([&] { renderer.submit(); }), "pending"));
    EXPECT_TRUE(contains(error_of([&] { renderer.draw(); }), "pending"));
    EXPECT_TRUE(is_green(middle_of(renderer.collect())));
    EXPECT_TRUE(is_background(middle_of(renderer.collect())));
    renderer.collect();
    EXPECT_TRUE(contains(error_of([&] { renderer.collect(); }), "pending"));
}

TEST(Renderer, refuses_impossible_sizes_and_cameras) {
    World world({}, on(DeviceKind::Cpu));
    EXPECT_TRUE(contains(error_of([&] { Renderer(world, 0, 10, k_camera); }), "0 x 10"));
    EXPECT_TRUE(contains(error_of([&] { Renderer(world, 10, 4'000'000, k_camera); }), "10 x 4000000"));
    EXPECT_TRUE(contains(error_of([&] { Renderer(world, 10, 10, {{1, 1, 1}, {1, 1, 1}, 0.7f}); }), "eye and target"));
    EXPECT_TRUE(contains(error_of([&] { Renderer(world, 10, 10, {{1, 1, 1}, {}, 0.0f}); }), "field of view"));
    // Straight down is no special case to the user.
    EXPECT_EQ(error_of([&] { Renderer(world, 10, 10, {{0, 9, 0}, {}, 0.7f}).draw(); }), "no error");
}

TEST_F(Files, a_png_holds_the_pixels_of_the_picture) {
    const Picture picture = gradient(33, 17);
    write_png(folder / "a.png", picture);
    EXPECT_EQ(file_count(), 1u);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_file(&image, (folder / "a.png").c_str()));
    EXPECT_EQ(image.width, 33u);
    EXPECT_EQ(image.height, 17u);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    ASSERT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
    EXPECT_EQ(pixels, picture.rgb);
}

TEST_F(Files, a_png_that_cannot_be_written_leaves_nothing_behind) {
    EXPECT_TRUE(contains(error_of([&] { write_png(folder / "none" / "a.png", gradient(8, 8)); }), "No such file"));
    std::filesystem::create_directories(folder / "taken.png");
    EXPECT_TRUE(contains(error_of([&] { write_png(folder / "taken.png", gradient(8, 8)); }), "taken.png"));
    EXPECT_TRUE(contains(error_of([&] { write_png(folder / "b.png", Picture{8, 8, {}}); }), "pixels"));
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(Files, a_video_appears_when_it_is_finished) {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
        std::cerr << "NO FFMPEG, NOT TESTED\n";
        GTEST_SKIP();
    }
    // A name that looks like an option, an address and a shell command.
    const std::filesystem::path path = folder / "-a:b $(c) 'd'.mp4";
    VideoWriter video(path, 64, 48, 30.0);
    for (int i = 0; i < 10; ++i)
        video.add(gradient(64, 48, i));
    EXPECT_FALSE(std::filesystem::exists(path));
    video.finish();
    EXPECT_EQ(file_count(), 1u);
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(bytes.substr(4, 4), "ftyp");
    EXPECT_LT(bytes.find("moov"), bytes.find("mdat")) << "the index comes first, so that players can start at once";
    EXPECT_TRUE(contains(error_of([&] { video.add(gradient(64, 48)); }), "finished already"));
}

TEST_F(Files, an_unfinished_video_leaves_nothing_behind) {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
        std::cerr << "NO FFMPEG, NOT TESTED\n";
        GTEST_SKIP();
    }
    {
        VideoWriter video(folder / "a.mp4", 64, 48, 30.0);
        video.add(gradient(64, 48));
        EXPECT_TRUE(contains(error_of([&] { video.add(gradient(32, 48)); }), "32 x 48"));
    }
    EXPECT_TRUE(contains(error_of([&] { VideoWriter(folder / "b.mp4", 64, 48, 30.0).finish(); }), "no picture"));
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(Files, a_video_that_cannot_be_written_is_refused_in_words) {
    EXPECT_TRUE(contains(error_of([&] { VideoWriter(folder / "a.mp4", 63, 48, 30.0); }), "even"));
    EXPECT_TRUE(contains(error_of([&] { VideoWriter(folder / "a.mp4", 64, 48, 0.0); }), "frames a second"));
    EXPECT_TRUE(contains(error_of([&] { VideoWriter(folder / "none" / "a.mp4", 64, 48, 30.0); }), "does not exist"));
    {
        const Variable empty("PATH", folder.string());
        EXPECT_TRUE(contains(error_of([&] { VideoWriter(folder / "a.mp4", 64, 48, 30.0); }), "apt install ffmpeg"));
    }
    EXPECT_EQ(file_count(), 0u);
}

TEST_F(Files, an_ffmpeg_that_gives_up_is_quoted) {
    std::filesystem::create_directories(folder / "bin");
    const std::filesystem::path program = folder / "bin" / "ffmpeg";
    std::ofstream(program) << "#!/bin/sh\necho 'out of tape' >&2\nexit 3\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const Variable only("PATH", folder / "bin");
    VideoWriter video(folder / "a.mp4", 640, 480, 30.0);
    const std::string message = error_of([&] {
        for (int i = 0; i < 100; ++i)
            video.add(gradient(640, 480));
    });
    EXPECT_TRUE(contains(message, "out of tape")) << message;
    EXPECT_EQ(file_count(), 1u) << "only the folder of the program";
}

} // namespace
} // namespace talus::render
