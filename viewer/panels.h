// SPDX-License-Identifier: MIT
// The panels around the picture: what there is to see and to set, and what it does to the workbench.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"
#include "viewer/measurements.h"
#include "viewer/workbench.h"

namespace talus::viewer {

/// Scenes in a list with a search, their parameters, and a path to a file.
class ScenePanel {
public:
    void show(Workbench&);

private:
    void choose(const scenes::SceneInfo&, std::string_view parameters = "");
    /// Shows the scene that is open with its parameters, where another than before is; of a file there are none.
    void follow(const std::string& name);
    std::string specification() const;

    std::string search, path, followed;
    const scenes::SceneInfo* chosen = nullptr;
    std::vector<double> values; ///< of the chosen scene's parameters
};

/// Device, solver and broad phase.
void show_settings_panel(Workbench&);

/// Times, counts, energy and memory over the last steps.
class MeasurementsPanel {
public:
    void show(const Workbench&);

private:
    Measurements measurements;
};

class Panels {
public:
    void show(Workbench&, float scale);
    /// Pixels at the window's left side that the panels take.
    static std::uint32_t width(const Workbench&, float scale);

private:
    ScenePanel scene;
    MeasurementsPanel measurements;
};

} // namespace talus::viewer
