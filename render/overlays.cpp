// SPDX-License-Identifier: MIT
#include "render/overlays.h"

#include <array>

namespace talus::render {

std::span<const OverlayInfo> list_overlays() {
    static constexpr std::array<OverlayInfo, 10> overlays{{
        {"contacts", &Overlays::contacts, "contact points: pink, fainter where a body hides them"},
        {"normals", &Overlays::normals, "normals of contacts: pink"},
        {"impulses", &Overlays::impulses, "impulses along the normals: yellow arrows, the largest two bodies long"},
        {"aabbs", &Overlays::aabbs, "bounding boxes along the world's axes"},
        {"pairs", &Overlays::pairs, "bodies in a candidate pair: red"},
        {"colours", &Overlays::colours, "contacts as lines between bodies, in the colour of their batch"},
        {"islands", &Overlays::islands, "bodies that contacts join, in one colour; what sleeps in grey"},
        {"velocities", &Overlays::velocities, "the way of a quarter of a second: blue; axes of rotation: violet"},
        {"wireframe", &Overlays::wireframe, "edges alone"},
        {"transparent", &Overlays::transparent, "static bodies let what is behind them through"},
    }};
    return overlays;
}

} // namespace talus::render
