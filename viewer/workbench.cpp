// SPDX-License-Identifier: MIT
#include "viewer/workbench.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "cli/words.h"

namespace talus::viewer {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::seconds k_message_time{6};
constexpr double k_slowest = 1.0 / 64.0, k_fastest = 64.0;

glm::vec3 place_on(const Ray& ray, float distance) {
    return ray.origin + distance * ray.direction;
}

} // namespace

Workbench::Workbench(const std::string& scene, DeviceKind device, std::uint32_t threads, Session::Adjust settings)
    : session(scene, device, threads, std::move(settings)) {
    session.before_step = [this](World& world) { return hand.apply(world); };
    look_from_start();
}

// ---- scenes ----

void Workbench::open(const std::string& specification) {
    attempt([&] {
        session.open(specification);
        let_all_go();
        look_from_start();
        is_new_scene = true;
        const std::vector<std::string>& warnings = session.scene().warnings;
        say(fmt::format("opened {}{}{}", session.scene().name, warnings.empty() ? "" : "\n",
                        fmt::join(warnings, "\n")));
    });
}

void Workbench::reset() {
    attempt([&] {
        session.reset();
        let_all_go();
    });
}

void Workbench::reseed() {
    const std::string& name = session.scene().name;
    const std::size_t place = name.find("seed=");
    if (place == std::string::npos) {
        say(name + " is not random: it has no seed");
        return;
    }
    const std::size_t end = std::min(name.find(',', place), name.size());
    const std::string other =
        name.substr(0, place) + "seed=" + std::to_string(std::random_device{}()) + name.substr(end);
    attempt([&] {
        session.open(other);
        let_all_go();
    });
}

void Workbench::move_to(DeviceKind device) {
    attempt([&] {
        session.move_to(device);
        say("on the " + session.world().device().name);
    });
}

void Workbench::set_settings(const Settings& settings) {
    attempt([&] { session.change().set_settings(settings); });
}

// ---- time ----

void Workbench::toggle_running() {
    session.running = !session.running;
}

void Workbench::step() {
    session.running = false;
    attempt([&] { session.step(); });
}

void Workbench::step_back() {
    session.running = false;
    let_go();
    attempt([&] {
        if (!session.step_back()) say("there is no earlier step to go back to");
    });
}

void Workbench::change_speed(double factor) {
    session.speed = std::clamp(session.speed * factor, k_slowest, k_fastest);
    say(fmt::format("speed × {:g}", session.speed));
}

void Workbench::advance(std::chrono::duration<double> elapsed, const Ray& pointer) {
    if (hand.is_holding()) {
        const float along = glm::dot(pointer.direction, camera.forward());
        if (along > 0.05f) hand.pull_to(place_on(pointer, grip_depth / along));
    }
    if (!attempt([&] { session.advance(display.is_recording() ? Display::k_frame_time : elapsed); }))
        session.running = false;
}

// ---- by hand ----

bool Workbench::take_hold(const Ray& ray) {
    const std::optional<Hit> hit = pick(session.world(), ray);
    if (hit && session.world().kind(hit->body) == BodyKind::Kinematic) {
        drive_from_now_on(hit->body);
        say("the arrow keys drive this body");
    }
    if (!hit || session.world().kind(hit->body) != BodyKind::Rigid) return false;
    hand.hold(session.world(), *hit);
    grip_depth = hit->distance * glm::dot(ray.direction, camera.forward());
    return true;
}

void Workbench::let_go() {
    hand.release();
}

void Workbench::let_all_go() {
    let_go();
    driven = {};
    driven_velocity = {};
}

void Workbench::reach(float notches) {
    grip_depth *= std::pow(1.1f, notches);
}

void Workbench::shoot(const Ray& ray) {
    attempt([&] { session.change().add(ball_along(ray, projectile)); });
}

void Workbench::drop_box(const Ray& ray) {
    const std::optional<Hit> hit = pick(session.world(), ray);
    const glm::vec3 place = place_on(ray, hit ? hit->distance : camera.reach());
    attempt([&] { session.change().add(box_above(place, projectile)); });
}

void Workbench::add_platform(const Ray& ray) {
    const std::optional<Hit> hit = pick(session.world(), ray);
    const float size = display.typical_size();
    const glm::vec3 place = hit ? hit->point + 0.5f * size * hit->normal : place_on(ray, camera.reach());
    attempt([&] { drive_from_now_on(session.change().add(platform_at(place, size))); });
}

void Workbench::drive_from_now_on(BodyId body) {
    drive({});
    driven = body;
}

void Workbench::drive(glm::vec3 direction) {
    if (direction == glm::vec3(0.0f) && driven_velocity == Vec3{}) return;
    const World& world = session.world();
    const bool chosen = world.contains(driven) && world.kind(driven) == BodyKind::Kinematic;
    const std::optional<BodyId> body = chosen ? driven : find_kinematic(world);
    if (!body) {
        driven_velocity = {};
        if (direction != glm::vec3(0.0f)) say("there is no kinematic body to drive; K adds a platform");
        return;
    }
    const float speed = 4.0f * display.typical_size(); // m/s
    const glm::vec3 level = glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), camera.right());
    const glm::vec3 wanted =
        speed * (direction.x * camera.right() + glm::vec3(0.0f, direction.y, 0.0f) + direction.z * level);
    const Vec3 velocity{wanted.x, wanted.y, wanted.z};
    if (velocity == driven_velocity) return;
    driven_velocity = velocity;
    attempt([&] { session.change().set_velocity(*body, {velocity, {}}); });
}

void Workbench::remove_body(const Ray& ray) {
    const std::optional<Hit> hit = pick(session.world(), ray);
    if (hit) attempt([&] { session.change().remove(hit->body); });
}

void Workbench::look_at(const Ray& ray) {
    if (const std::optional<Hit> hit = pick(session.world(), ray)) camera.set_target(hit->point);
}

void Workbench::look_from_start() {
    camera.look_through(session.scene().camera, aspect);
}

// ---- files ----

fs::path Workbench::next_file(const std::string& ending) const {
    const std::string& name = session.scene().name;
    const std::string base = fs::path(name.substr(0, name.find(':'))).stem().string();
    for (int number = 1;; ++number) {
        const fs::path path = fmt::format("{}-{}{}", base, number, ending);
        std::error_code ignored;
        if (!fs::exists(path, ignored)) return path;
    }
}

void Workbench::save_picture() {
    attempt([&] {
        const fs::path path = next_file(".png");
        display.save_picture(path);
        say("wrote " + path.string());
    });
}

void Workbench::toggle_video() {
    attempt([&] {
        if (display.is_recording()) {
            display.finish_video();
            say("wrote " + video_file.string());
        } else {
            video_file = next_file(".mp4");
            display.start_video(video_file);
            say("recording " + video_file.string());
        }
    });
}

void Workbench::save_snapshot() {
    attempt([&] {
        const fs::path path = next_file(".snapshot");
        session.save(path);
        newest_snapshot = path;
        say("wrote " + path.string());
    });
}

void Workbench::load_snapshot() {
    if (newest_snapshot.empty()) {
        say("no snapshot was saved yet; drop a .snapshot file into the window to open it");
        return;
    }
    attempt([&] {
        session.load(newest_snapshot);
        let_all_go();
        say("loaded " + newest_snapshot.string());
    });
}

void Workbench::after_draw() {
    if (is_new_scene) projectile.size = display.typical_size();
    is_new_scene = false;
}

std::string Workbench::message() const {
    return std::chrono::steady_clock::now() - message_time < k_message_time ? newest_message : std::string();
}

void Workbench::say(const std::string& text) {
    newest_message = text;
    message_time = std::chrono::steady_clock::now();
}

} // namespace talus::viewer
