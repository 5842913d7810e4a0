// SPDX-License-Identifier: MIT
// The window's pictures without a window: how fast they can be made, where no screen sets the pace or there is none.
#pragma once

#include "viewer/viewer.h"

namespace talus::viewer {

/// Draws for `seconds` (10 where they are not given) in a headless context, a step and a picture in turns, and prints
/// the frame rate. Throws Error where the scene, the device or a context cannot be had.
void run_offscreen(const ViewOptions&);

} // namespace talus::viewer
