// SPDX-License-Identifier: MIT
// What can be drawn besides the bodies.
#pragma once

#include <span>
#include <string_view>

namespace talus::render {

struct Overlays {
    bool contacts = false;
    bool normals = false;
    bool impulses = false;
    bool aabbs = false;
    bool pairs = false;
    bool colours = false;
    bool islands = false;
    bool velocities = false;
    bool wireframe = false;
    bool transparent = false;
};

struct OverlayInfo {
    std::string_view name; ///< on the command line
    bool Overlays::*shown;
    const char* meaning;
};

/// In the order in which they are listed.
std::span<const OverlayInfo> list_overlays();

} // namespace talus::render
