// SPDX-License-Identifier: MIT
// All that keys and panels work on, and what they can do with it. What goes wrong becomes a message on the screen.
#pragma once

#include <chrono>
#include <filesystem>
#include <new>
#include <string>

#include "viewer/camera_control.h"
#include "viewer/display.h"
#include "viewer/hand.h"
#include "viewer/session.h"

namespace talus::viewer {

/// Does something. The reason in words where it throws Error or memory is not enough; otherwise nothing.
template <typename Action> std::string failure_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    } catch (const std::bad_alloc&) {
        return "there is not enough memory for that";
    }
    return {};
}

class Workbench {
public:
    Workbench(const std::string& scene, DeviceKind, std::uint32_t threads, Session::Adjust settings);

    Session session;
    Display display;
    CameraControl camera;
    Hand hand;
    Projectile projectile;
    float aspect = 16.0f / 9.0f; ///< of the picture, width over height
    bool show_panels = true;
    bool show_help = false;

    // ---- scenes ----
    /// Also a file: a scene (.gltf, .glb) or a snapshot (.snapshot).
    void open(const std::string& specification);
    void reset();
    /// The same scene with another seed; says so where it has none.
    void reseed();
    void move_to(DeviceKind);
    void set_settings(const Settings&);

    // ---- time ----
    void toggle_running();
    void step();
    void step_back();
    void change_speed(double factor);
    /// A frame's share of time: steps, forces, the mouse's pull. `pointer` leads through the mouse.
    void advance(std::chrono::duration<double> elapsed, const Ray& pointer);

    // ---- by hand ----
    /// Whether there was a body to take hold of; a kinematic one is driven from then on instead.
    bool take_hold(const Ray&);
    void let_go();
    void reach(float notches); ///< what is held: farther (positive) or nearer
    void shoot(const Ray&);
    void drop_box(const Ray&);
    void add_platform(const Ray&); ///< which the keys drive from then on
    /// Moves the kinematic body that was clicked at or added last, otherwise the first, in camera axes, each from -1 to
    /// 1: right, up, away.
    void drive(glm::vec3 direction);
    void remove_body(const Ray&);
    void look_at(const Ray&);
    void look_from_start(); ///< as the scene has it

    // ---- files, in the current folder ----
    void save_picture();
    void toggle_video();
    void save_snapshot();
    void load_snapshot(); ///< the one that was saved last

    /// To be called after a frame was drawn: adapts what is thrown in to a new scene's bodies.
    void after_draw();

    /// The newest message, or nothing a few seconds after it came.
    std::string message() const;
    void say(const std::string&);
    /// Does something; where it fails, the reason becomes the message. False then.
    template <typename Action> bool attempt(const Action& action) {
        const std::string reason = failure_of(action);
        if (!reason.empty()) say(reason);
        return reason.empty();
    }

private:
    /// Before another world comes: nothing is held or driven.
    void let_all_go();
    void drive_from_now_on(BodyId);
    std::filesystem::path next_file(const std::string& ending) const;

    std::string newest_message;
    std::chrono::steady_clock::time_point message_time;
    std::filesystem::path newest_snapshot, video_file;
    float grip_depth = 0.0f; ///< m, along the camera's direction
    BodyId driven;           ///< by the keys; may be gone
    Vec3 driven_velocity;    ///< that it was given
    bool is_new_scene = true;
};

} // namespace talus::viewer
