// SPDX-License-Identifier: MIT
// A window with a scene in it.
#pragma once

#include <cstdint>
#include <optional>

#include "cli/run_options.h"
#include "render/overlays.h"

namespace talus::viewer {

struct ViewOptions {
    cli::SimulationOptions simulation; ///< all but the number of steps
    render::Overlays overlays;
    std::uint32_t width = 1280, height = 720;
    bool paused = false;
    std::optional<double> seconds; ///< after which the window closes, and says how many frames it showed
    bool offscreen = false;        ///< no window: how fast its pictures can be made
};

/// Returns when the window is closed. Throws Error where no window can be opened, or the scene or the device cannot be
/// had; in a build without the window, always, and says what it was built without.
void run_viewer(const ViewOptions&);

} // namespace talus::viewer
