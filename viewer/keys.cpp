// SPDX-License-Identifier: MIT
#include "viewer/keys.h"

#include <array>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace talus::viewer {

namespace {

/// Overlay `number`, from 0, on or off.
template <std::size_t number> void toggle_overlay(const KeyContext& context) {
    const render::OverlayInfo& overlay = render::list_overlays()[number];
    bool& shown = context.bench.display.overlays.*overlay.shown;
    shown = !shown;
    context.bench.say(std::string(overlay.name) + (shown ? ": " + std::string(overlay.meaning) : " off"));
}

void switch_device(const KeyContext& context) {
    constexpr std::array order{DeviceKind::Gpu, DeviceKind::Cpu, DeviceKind::Hybrid};
    std::size_t place = 0;
    while (order[place] != context.bench.session.device())
        ++place;
    context.bench.move_to(order[(place + 1) % order.size()]);
}

void switch_camera(const KeyContext& context) {
    CameraControl& camera = context.bench.camera;
    camera.mode = camera.mode == CameraMode::Orbit ? CameraMode::Fly : CameraMode::Orbit;
    context.bench.say(camera.mode == CameraMode::Orbit ? "the camera orbits" : "the camera flies: W A S D Q E");
}

void escape(const KeyContext& context) {
    if (context.bench.hand.is_holding())
        context.bench.let_go();
    else
        context.bench.show_help = false;
}

using Context = const KeyContext&;

constexpr std::array k_keys{
    KeyBinding{GLFW_KEY_F1, "F1", "this page", [](Context c) { c.bench.show_help = !c.bench.show_help; }},
    KeyBinding{GLFW_KEY_TAB, "Tab", "panels: show, hide",
               [](Context c) { c.bench.show_panels = !c.bench.show_panels; }},
    KeyBinding{GLFW_KEY_F11, "F11", "full screen", [](Context c) { c.window.toggle_full_screen(); }},
    KeyBinding{GLFW_KEY_ESCAPE, "Esc", "let go; close this page", escape},
    KeyBinding{GLFW_KEY_Q, "Ctrl+Q", "quit", [](Context c) { c.window.close(); }, true},

    KeyBinding{GLFW_KEY_SPACE, "Space", "run, pause", [](Context c) { c.bench.toggle_running(); }},
    KeyBinding{GLFW_KEY_PERIOD, ".", "one step", [](Context c) { c.bench.step(); }, false, true},
    KeyBinding{GLFW_KEY_COMMA, ",", "one step back", [](Context c) { c.bench.step_back(); }, false, true},
    KeyBinding{GLFW_KEY_R, "R", "reset: the scene from its start", [](Context c) { c.bench.reset(); }},
    KeyBinding{GLFW_KEY_N, "N", "the scene with another random seed", [](Context c) { c.bench.reseed(); }},
    KeyBinding{GLFW_KEY_MINUS, "-", "half the speed", [](Context c) { c.bench.change_speed(0.5); }},
    KeyBinding{GLFW_KEY_EQUAL, "=", "twice the speed", [](Context c) { c.bench.change_speed(2.0); }},
    KeyBinding{GLFW_KEY_G, "G", "next device: gpu, cpu, hybrid", switch_device},

    KeyBinding{GLFW_KEY_B, "B", "shoot a ball to where the mouse points", [](Context c) { c.bench.shoot(c.pointer); }},
    KeyBinding{GLFW_KEY_X, "X", "drop a box there", [](Context c) { c.bench.drop_box(c.pointer); }},
    KeyBinding{GLFW_KEY_DELETE, "Del", "remove the body there", [](Context c) { c.bench.remove_body(c.pointer); }},
    KeyBinding{GLFW_KEY_K, "K", "add a platform, a kinematic body, there",
               [](Context c) { c.bench.add_platform(c.pointer); }},

    KeyBinding{GLFW_KEY_C, "C", "camera: orbit, fly", switch_camera},
    KeyBinding{GLFW_KEY_F, "F", "look at the body there", [](Context c) { c.bench.look_at(c.pointer); }},
    KeyBinding{GLFW_KEY_HOME, "Home", "the camera as the scene has it", [](Context c) { c.bench.look_from_start(); }},

    KeyBinding{GLFW_KEY_F2, "F2", "save a picture", [](Context c) { c.bench.save_picture(); }},
    KeyBinding{GLFW_KEY_F3, "F3", "record a video: begin, end", [](Context c) { c.bench.toggle_video(); }},
    KeyBinding{GLFW_KEY_F5, "F5", "save a snapshot", [](Context c) { c.bench.save_snapshot(); }},
    KeyBinding{GLFW_KEY_F9, "F9", "load the snapshot that was saved last", [](Context c) { c.bench.load_snapshot(); }},

    KeyBinding{GLFW_KEY_1, "1", "show contact points", toggle_overlay<0>},
    KeyBinding{GLFW_KEY_2, "2", "show normals of contacts", toggle_overlay<1>},
    KeyBinding{GLFW_KEY_3, "3", "show impulses", toggle_overlay<2>},
    KeyBinding{GLFW_KEY_4, "4", "show bounding boxes", toggle_overlay<3>},
    KeyBinding{GLFW_KEY_5, "5", "show candidate pairs", toggle_overlay<4>},
    KeyBinding{GLFW_KEY_6, "6", "show colours of the constraint graph", toggle_overlay<5>},
    KeyBinding{GLFW_KEY_7, "7", "show islands", toggle_overlay<6>},
    KeyBinding{GLFW_KEY_8, "8", "show velocities", toggle_overlay<7>},
    KeyBinding{GLFW_KEY_9, "9", "wireframe", toggle_overlay<8>},
    KeyBinding{GLFW_KEY_0, "0", "static bodies transparent", toggle_overlay<9>},
};

constexpr std::array k_gestures{
    Gesture{"left button", "on a body: drag it; on a kinematic one: drive it from now on; elsewhere: turn the camera"},
    Gesture{"right button", "turn the camera"},
    Gesture{"middle button, or Shift + left", "move the camera sideways"},
    Gesture{"wheel", "nearer, farther; while dragging: the body"},
    Gesture{"W A S D Q E", "fly: on, left, back, right, down, up; with Shift faster"},
    Gesture{"arrows, Page Up, Page Down", "drive the kinematic body"},
    Gesture{"files dropped here", "scenes (.gltf, .glb) and snapshots (.snapshot)"},
};

} // namespace

std::span<const KeyBinding> list_keys() {
    return k_keys;
}

std::span<const Gesture> list_gestures() {
    return k_gestures;
}

void press_key(int key, bool control, bool repeated, const KeyContext& context) {
    for (const KeyBinding& binding : k_keys)
        if (binding.key == key && binding.control == control && (binding.repeats || !repeated)) binding.press(context);
}

} // namespace talus::viewer
