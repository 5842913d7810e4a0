// SPDX-License-Identifier: MIT
// What each key does: one table for the keyboard and for the help page.
#pragma once

#include <span>

#include "viewer/window.h"
#include "viewer/workbench.h"

namespace talus::viewer {

/// What a key's work may need.
struct KeyContext {
    Workbench& bench;
    Window& window;
    Ray pointer; ///< through the mouse
};

struct KeyBinding {
    int key;
    const char* name;    ///< as it stands on the keyboard
    const char* meaning; ///< null: the one above says it
    void (*press)(const KeyContext&);
    bool control = false;
    bool repeats = false; ///< while it is held
};

std::span<const KeyBinding> list_keys();

/// What is done with the mouse, and with keys that are held.
struct Gesture {
    const char* name;
    const char* meaning;
};
std::span<const Gesture> list_gestures();

/// Does what the key is for; unknown keys do nothing.
void press_key(int key, bool control, bool repeated, const KeyContext&);

} // namespace talus::viewer
