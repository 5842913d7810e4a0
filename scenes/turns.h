// SPDX-License-Identifier: MIT
// Rotations about one axis, in radians. Worked out in double precision: libraries whose sines differ in the last bit
// then almost always round to the same float.
#pragma once

#include <cmath>

#include <talus/types.h>

namespace talus::scenes {

inline Quat turn_about_y(double angle) {
    return {0.0f, static_cast<float>(std::sin(0.5 * angle)), 0.0f, static_cast<float>(std::cos(0.5 * angle))};
}

inline Quat turn_about_z(double angle) {
    return {0.0f, 0.0f, static_cast<float>(std::sin(0.5 * angle)), static_cast<float>(std::cos(0.5 * angle))};
}

} // namespace talus::scenes
