// SPDX-License-Identifier: MIT
// The window's parts that need no window: camera, ray cast, spring, history, session.
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "viewer/camera_control.h"
#include "viewer/hand.h"
#include "viewer/keys.h"
#include "viewer/measurements.h"
#include "viewer/session.h"
#include "viewer/workbench.h"

namespace talus::viewer {
namespace {

constexpr float k_near = 1e-4f;

Settings settings_of_scene(const scenes::Scene& scene) {
    return scene.settings;
}

Session make_session(const std::string& specification) {
    return {specification, DeviceKind::Cpu, 1, settings_of_scene};
}

BodyDefinition box_at(Vec3 position, Vec3 size = {1.0f, 1.0f, 1.0f}) {
    BodyDefinition definition;
    definition.shape = Box{size};
    definition.pose.position = position;
    return definition;
}

World make_world() {
    WorldOptions options;
    options.device = DeviceKind::Cpu;
    options.threads = 1;
    return World({}, options);
}

} // namespace

// ---- camera ----

TEST(CameraControl, keeps_the_scenes_view) {
    const scenes::Camera given{{3.0f, 4.0f, 5.0f}, {-1.0f, 0.5f, 2.0f}, 0.6f};
    CameraControl control;
    control.look_through(given);
    const scenes::Camera camera = control.camera();
    EXPECT_NEAR(camera.eye.x, 3.0f, k_near);
    EXPECT_NEAR(camera.eye.y, 4.0f, k_near);
    EXPECT_NEAR(camera.eye.z, 5.0f, k_near);
    EXPECT_EQ(camera.target, given.target);
    EXPECT_EQ(camera.vertical_fov, 0.6f);
}

TEST(CameraControl, orbits_around_its_target_and_flies_around_its_eye) {
    CameraControl control;
    control.look_through({{0.0f, 2.0f, 8.0f}, {}, 0.7f});
    const float distance = control.reach();
    control.turn({0.1f, 0.05f});
    EXPECT_EQ(control.camera().target, Vec3{});
    EXPECT_NEAR(glm::length(control.eye()), distance, k_near);
    EXPECT_LT(control.eye().x, 0.0f); // the world follows the mouse to the right: the eye goes left
    EXPECT_GT(control.eye().y, 2.0f); // and it follows down: the eye goes up

    control.mode = CameraMode::Fly;
    const glm::vec3 eye = control.eye(), ahead = control.forward();
    control.turn({0.1f, 0.0f});
    EXPECT_NEAR(glm::distance(control.eye(), eye), 0.0f, k_near);
    EXPECT_GT(glm::dot(control.forward(), control.right()), -k_near);
    EXPECT_LT(glm::dot(control.forward(), ahead), 0.999f);
    control.fly({0.0f, 0.0f, 1.0f}, 0.5f);
    EXPECT_GT(glm::dot(control.eye() - eye, control.forward()), 0.1f * distance);
}

TEST(CameraControl, rays_lead_to_where_things_are_drawn) {
    CameraControl control;
    control.look_through({{4.0f, 3.0f, 6.0f}, {0.0f, 1.0f, 0.0f}, 0.8f});
    EXPECT_NEAR(glm::distance(control.ray_through({0.0f, 0.0f}, 1.5f), control.forward()), 0.0f, k_near);
    // The upper edge lies half the field of view above the middle.
    const glm::vec3 up = control.ray_through({0.0f, 1.0f}, 1.5f);
    EXPECT_NEAR(std::acos(glm::dot(up, control.forward())), 0.4f, k_near);
    EXPECT_GT(glm::dot(control.ray_through({1.0f, 0.0f}, 1.5f), control.right()), 0.5f);
    control.pan({0.0f, 0.25f}); // down by a quarter of the window: the target's height falls out of the middle
    EXPECT_GT(control.camera().target.y, 1.0f);
}

TEST(CameraControl, stays_upright_and_finite) {
    CameraControl control;
    control.look_through({{0.0f, 5.0f, 0.0f}, {}, 0.7f}); // straight down
    for (int i = 0; i < 100; ++i) {
        control.turn({0.3f, 0.7f});
        control.zoom(5.0f);
    }
    EXPECT_GE(control.reach(), 0.009f);
    EXPECT_TRUE(std::isfinite(control.eye().x + control.eye().y + control.eye().z));
    EXPECT_LT(std::abs(control.forward().y), 1.0f);
}

// ---- picking ----

TEST(Pick, meets_boxes_and_spheres_where_they_are) {
    const float half = std::sqrt(0.5f);
    const Pose turned{{0.0f, 0.0f, -5.0f}, {0.0f, std::sin(0.39269908f), 0.0f, std::cos(0.39269908f)}}; // 45° about y
    const Ray ahead{{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}};
    const auto box = meet(ahead, Box{{1.0f, 1.0f, 1.0f}}, turned);
    ASSERT_TRUE(box);
    EXPECT_NEAR(box->distance, 5.0f - half, k_near); // its edge looks here
    const auto sphere = meet(ahead, Sphere{0.5f}, turned);
    ASSERT_TRUE(sphere);
    EXPECT_NEAR(sphere->distance, 4.5f, k_near);
    EXPECT_NEAR(glm::distance(sphere->normal, glm::vec3(0.0f, 0.0f, 1.0f)), 0.0f, k_near);
    EXPECT_FALSE(meet({{0.6f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}}, Sphere{0.5f}, turned));
    EXPECT_TRUE(meet({{0.6f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}}, Box{{1.0f, 1.0f, 1.0f}}, turned));
    EXPECT_FALSE(meet({{0.8f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}}, Box{{1.0f, 1.0f, 1.0f}}, turned));
    EXPECT_FALSE(meet({{}, {0.0f, 0.0f, 1.0f}}, Sphere{0.5f}, turned)) << "behind";
    EXPECT_FALSE(meet({{0.0f, 0.0f, -5.0f}, {0.0f, 0.0f, -1.0f}}, Box{}, turned)) << "inside";
}

TEST(Pick, agrees_with_points_on_the_surface) {
    // Rays to random points of a box's surface: each must end on the surface, at that point or before it.
    const Box box{{1.0f, 2.0f, 0.4f}};
    const Pose pose{{2.0f, -1.0f, 3.0f}, {0.5f, 0.1f, -0.7f, 0.5f}};
    const glm::quat q(0.5f, 0.5f, 0.1f, -0.7f);
    std::uint32_t state = 1;
    const auto random = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
    };
    for (int i = 0; i < 500; ++i) {
        glm::vec3 local(0.5f * random(), random(), 0.2f * random());
        const int axis = i % 3;
        local[axis] = std::copysign(0.5f * glm::vec3(1.0f, 2.0f, 0.4f)[axis], local[axis]);
        const glm::vec3 point = glm::vec3(2.0f, -1.0f, 3.0f) + q * local;
        const glm::vec3 origin(10.0f * random(), 10.0f + 5.0f * random(), 10.0f * random());
        const Ray ray{origin, glm::normalize(point - origin)};
        const auto hit = meet(ray, box, pose);
        ASSERT_TRUE(hit) << i;
        EXPECT_LE(hit->distance, glm::distance(point, origin) + 1e-3f) << i;
        const glm::vec3 on = glm::conjugate(q) * (hit->point - glm::vec3(2.0f, -1.0f, 3.0f));
        const glm::vec3 reach = glm::abs(on) - glm::vec3(0.5f, 1.0f, 0.2f);
        EXPECT_NEAR(std::max({reach.x, reach.y, reach.z}), 0.0f, 1e-3f) << i;
        EXPECT_LT(glm::dot(hit->normal, ray.direction), 0.0f) << i;
    }
}

TEST(Pick, takes_the_nearest_body) {
    World world = make_world();
    world.add(box_at({0.0f, 0.0f, -9.0f}));
    const BodyId near = world.add(box_at({0.0f, 0.0f, -4.0f}));
    world.add(box_at({0.0f, 3.0f, -2.0f}));
    const auto hit = pick(world, {{}, {0.0f, 0.0f, -1.0f}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->body, near);
    EXPECT_NEAR(hit->distance, 3.5f, k_near);
    world.set_sensor(near, true);
    EXPECT_NEAR(pick(world, {{}, {0.0f, 0.0f, -1.0f}})->distance, 8.5f, k_near) << "the body behind a sensor";
    EXPECT_FALSE(pick(world, {{}, {1.0f, 0.0f, 0.0f}}));
}

// ---- the spring ----

TEST(Hand, brings_the_held_point_to_the_mouse_and_keeps_it_there) {
    // A long beam held at a corner, a cube, a small heavy and a large light ball.
    const std::vector<Shape> shapes{Box{{4.0f, 0.2f, 0.3f}}, Box{{1.0f, 1.0f, 1.0f}}, Sphere{0.05f}, Sphere{3.0f}};
    for (const Shape& shape : shapes) {
        World world = make_world();
        BodyDefinition definition = box_at({});
        definition.shape = shape;
        const BodyId body = world.add(definition);
        const auto* box = std::get_if<Box>(&shape);
        const glm::vec3 grip = box != nullptr ? 0.5f * glm::vec3(box->size.x, box->size.y, box->size.z)
                                              : glm::vec3(0.0f, std::get<Sphere>(shape).radius, 0.0f);
        Hand hand;
        hand.hold(world, {body, 1.0f, grip, {}});
        EXPECT_EQ(hand.pull(world)->second, grip);
        const glm::vec3 target(1.0f, 2.0f, -1.0f);
        hand.pull_to(target);
        float farthest = 0.0f;
        for (int i = 0; i < 240; ++i) {
            ASSERT_TRUE(hand.apply(world));
            world.step();
            farthest = std::max(farthest, glm::distance(hand.pull(world)->first, grip));
        }
        const glm::vec3 point = hand.pull(world)->first;
        EXPECT_LT(glm::distance(point, target), 0.02f) << shape.index();
        EXPECT_LT(farthest, 1.2f * glm::distance(target, grip)) << shape.index() << ": it overshoots";
        // Let go, it falls.
        hand.release();
        EXPECT_FALSE(hand.apply(world));
        world.step(10);
        EXPECT_LT(world.velocity(body).linear.y, -1.0f);
    }
}

TEST(Hand, catches_what_flies_and_spins) {
    World world = make_world();
    BodyDefinition box = box_at({}, {1.0f, 2.0f, 0.5f});
    box.velocity = {{6.0f, -9.0f, 5.0f}, {9.0f, -7.0f, 8.0f}};
    Hand hand;
    hand.hold(world, {world.add(box), 1.0f, {0.5f, 0.9f, 0.25f}, {}});
    const glm::vec3 target(0.0f, 1.0f, 0.0f);
    hand.pull_to(target);
    for (int i = 0; i < 360; ++i) {
        hand.apply(world);
        world.step();
        ASSERT_LT(glm::distance(hand.pull(world)->first, target), 5.0f) << i;
    }
    EXPECT_LT(glm::distance(hand.pull(world)->first, target), 0.02f);
}

TEST(Hand, holds_rigid_bodies_alone) {
    World world = make_world();
    BodyDefinition wall = box_at({});
    wall.kind = BodyKind::Static;
    Hand hand;
    hand.hold(world, {world.add(wall), 1.0f, {}, {}});
    EXPECT_FALSE(hand.is_holding());
    const BodyId box = world.add(box_at({0.0f, 3.0f, 0.0f}));
    hand.hold(world, {box, 1.0f, {0.0f, 3.5f, 0.0f}, {}});
    EXPECT_TRUE(hand.is_holding());
    world.remove(box);
    EXPECT_FALSE(hand.apply(world));
    EXPECT_FALSE(hand.is_holding());
}

// ---- history and session ----

TEST(Session, steps_back_to_the_same_bits) {
    Session session = make_session("pool:boxes=30");
    std::vector<std::uint64_t> hashes{session.world().state_hash()};
    for (int i = 0; i < 40; ++i) {
        session.step();
        hashes.push_back(session.world().state_hash());
    }
    for (std::size_t step = 40; step-- > 0;) {
        ASSERT_TRUE(session.step_back());
        EXPECT_EQ(session.world().step_count(), step);
        EXPECT_EQ(session.world().state_hash(), hashes[step]);
    }
    EXPECT_FALSE(session.step_back());
    for (std::size_t step = 1; step <= 40; ++step) {
        session.step();
        EXPECT_EQ(session.world().state_hash(), hashes[step]);
    }
}

TEST(Session, steps_back_over_what_was_done_by_hand) {
    Session session = make_session("pyramid:base=3");
    std::vector<std::uint64_t> hashes;
    std::vector<std::size_t> counts;
    const auto note = [&] {
        hashes.push_back(session.world().state_hash());
        counts.push_back(session.world().body_count());
    };
    for (int i = 0; i < 5; ++i)
        session.step();
    session.change().add(ball_along({{0.0f, 1.0f, 5.0f}, {0.0f, 0.0f, -1.0f}}, {}));
    bool pulling = true;
    session.before_step = [&](World& world) {
        if (pulling) world.add_force(world.bodies()[2], {0.0f, 5000.0f, 0.0f});
        return pulling;
    };
    for (int i = 0; i < 10; ++i) {
        session.step();
        note();
    }
    pulling = false;
    for (int i = 0; i < 5; ++i)
        session.step();
    note();
    for (int i = 0; i < 5; ++i)
        session.step_back();
    for (std::size_t i = 10; i-- > 0;) {
        EXPECT_EQ(session.world().state_hash(), hashes[i]) << i;
        EXPECT_EQ(session.world().body_count(), counts[i]);
        session.step_back();
    }
    // The force that waited for the next step then waits again, though nobody pulls now.
    session.step();
    EXPECT_EQ(session.world().state_hash(), hashes[0]);
}

TEST(History, keeps_within_its_memory) {
    World world = make_world();
    world.add(box_at({0.0f, 9.0f, 0.0f}));
    const std::size_t one = world.snapshot().bytes();
    History history(10 * one);
    for (int i = 0; i < 50; ++i) {
        history.before_step(world);
        world.step();
    }
    EXPECT_LE(history.bytes(), 10 * one);
    EXPECT_GE(history.size(), 8u);
    EXPECT_EQ(history.first_step(world), 50u - history.size());
}

TEST(History, makes_steps_between_two_snapshots_again) {
    World world = make_world();
    for (const scenes::NamedBody& body : scenes::make_scene("pool:boxes=20").bodies)
        world.add(body.definition);
    History history(std::size_t{256} << 20, 1e-9); // as if taking one took very long
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 100; ++i) {
        history.before_step(world);
        hashes.push_back(world.state_hash());
        world.step();
    }
    EXPECT_EQ(history.size(), 1u);
    for (std::size_t step = 100; step-- > 40;) {
        ASSERT_TRUE(history.step_back(world));
        ASSERT_EQ(world.step_count(), step);
        EXPECT_EQ(world.state_hash(), hashes[step]) << step;
    }
    EXPECT_GT(history.size(), 1u) << "nothing is left on the way";
    // A change by hand is the end of what was ahead, and a place to go back to.
    world.set_velocity(world.bodies()[10], {{0.0f, 3.0f, 0.0f}, {}});
    history.note_change();
    history.before_step(world);
    world.step();
    const std::uint64_t thrown = world.state_hash();
    world.step();
    history.step_back(world);
    EXPECT_EQ(world.state_hash(), thrown);
}

TEST(Session, goes_on_from_a_file) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "talus_session.snapshot";
    Session session = make_session("stack:height=4");
    session.step();
    session.save(file);
    const std::uint64_t hash = session.world().state_hash();
    Session other = make_session("pyramid:base=2");
    other.load(file);
    EXPECT_EQ(other.world().state_hash(), hash);
    EXPECT_FALSE(other.step_back()) << "the past was another world's";
    std::filesystem::remove(file);
    EXPECT_THROW(other.load(file), Error);
    EXPECT_EQ(other.world().state_hash(), hash);
}

TEST(Session, starts_from_a_snapshot) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "talus_start.snapshot";
    World world = make_world();
    Settings settings;
    settings.gravity = {0.0f, -3.0f, 0.0f};
    world.set_settings(settings);
    world.add(box_at({40.0f, 5.0f, 7.0f}));
    world.step(9);
    world.snapshot().save(file);
    const std::uint64_t hash = world.state_hash();
    Session session = make_session(file.string());
    EXPECT_EQ(session.world().step_count(), 9u);
    EXPECT_EQ(session.world().settings().gravity, settings.gravity);
    EXPECT_NEAR(session.scene().camera.target.x, 40.0f, 0.5f); // it looks at what is there
    session.step();
    EXPECT_NE(session.world().state_hash(), hash);
    session.reset();
    EXPECT_EQ(session.world().state_hash(), hash);
    std::filesystem::remove(file);
    EXPECT_THROW(make_session(file.string()), Error);
}

TEST(Session, keeps_what_it_has_where_a_scene_cannot_be_had) {
    Session session = make_session("stack:height=4");
    session.step();
    const std::uint64_t hash = session.world().state_hash();
    EXPECT_THROW(session.open("stack:height=0"), Error);
    EXPECT_EQ(session.world().state_hash(), hash);
    EXPECT_EQ(session.scene().name, "stack:height=4");
    session.open("pyramid:base=2");
    EXPECT_EQ(session.world().body_count(), 4u);
    session.step();
    session.reset();
    EXPECT_EQ(session.world().step_count(), 0u);
}

TEST(Session, plays_at_the_speed_that_is_asked_for) {
    Session session = make_session("stack:height=1");
    session.speed = 0.5;
    for (int i = 0; i < 60; ++i)
        session.advance(std::chrono::duration<double>(1.0 / 30.0));
    EXPECT_NEAR(static_cast<double>(session.world().step_count()), 60.0, 1.0);
    session.running = false;
    session.advance(std::chrono::duration<double>(1.0));
    EXPECT_NEAR(static_cast<double>(session.world().step_count()), 60.0, 1.0);
}

TEST(Workbench, has_a_reason_for_what_fails) {
    EXPECT_EQ(failure_of([] {}), "");
    EXPECT_NE(failure_of([] { make_session("stack:height=0"); }).find("from 1 to 1000"), std::string::npos);
    EXPECT_NE(failure_of([] { throw std::bad_alloc(); }).find("memory"), std::string::npos);
}

TEST(Keys, all_are_in_the_documents) {
    std::ifstream file(TALUS_SOURCE_FOLDER "/docs/viewer.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const KeyBinding& key : list_keys()) {
        const std::string row = "| `" + std::string(key.name) + "` | " + key.meaning + " |";
        EXPECT_NE(text.find(row), std::string::npos) << row;
    }
    for (const Gesture& gesture : list_gestures()) {
        const std::string row = "| " + std::string(gesture.name) + " | " + gesture.meaning + " |";
        EXPECT_NE(text.find(row), std::string::npos) << row;
    }
    for (const render::OverlayInfo& overlay : render::list_overlays()) {
        const std::string row = "| `" + std::string(overlay.name) + "` | " + overlay.meaning + " |";
        EXPECT_NE(text.find(row), std::string::npos) << row;
    }
}

TEST(Keys, none_has_two_meanings) {
    std::set<std::pair<int, bool>> seen;
    for (const KeyBinding& key : list_keys())
        EXPECT_TRUE(seen.emplace(key.key, key.control).second) << key.name;
}

TEST(Measurements, energy_has_its_closed_form) {
    World world = make_world();
    BodyDefinition box = box_at({0.0f, 2.0f, 0.0f}, {1.0f, 2.0f, 3.0f});
    box.mass = 6.0f;
    box.velocity = {{3.0f, 0.0f, 4.0f}, {0.0f, 2.0f, 0.0f}};
    world.add(box);
    const Energy energy = energy_of(world);
    EXPECT_NEAR(energy.kinetic, 0.5 * 6.0 * 25.0 + 0.5 * (6.0 / 12.0 * (1.0 + 9.0)) * 4.0, 1e-4);
    EXPECT_NEAR(energy.potential, 6.0 * 9.81 * 2.0, 1e-3);
}

} // namespace talus::viewer
