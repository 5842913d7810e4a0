// SPDX-License-Identifier: MIT
// Cameras that fill a 16:9 picture with a region.
#pragma once

#include "scenes/scene.h"

namespace talus::scenes {

/// The nearest camera which sees all of `region` in a picture of 16:9, looking at it from `direction` (from the region
/// towards the eye, any length, not straight up or down), with a small margin.
Camera frame(const Bounds& region, Vec3 direction);

} // namespace talus::scenes
