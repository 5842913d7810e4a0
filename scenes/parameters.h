// SPDX-License-Identifier: MIT
// The parameters in a scene's specification: "height=30,seed=2" read against the list that the scene declares.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"

namespace talus::scenes {

/// One value for each parameter of a scene, given or default.
class Parameters {
public:
    /// `text` is what stands behind the scene's name and its colon. Throws Error on an unknown parameter, one given
    /// twice, or a value that is not allowed.
    Parameters(const SceneInfo&, std::string_view text);

    double value_of(std::string_view name) const;
    std::uint32_t integer(std::string_view name) const;
    float number(std::string_view name) const;
    /// "height=30,seed=1": every parameter, so that it can be given again.
    std::string text() const;

private:
    const SceneInfo& info;
    std::vector<double> values;
};

/// The candidate which is fewest edits (a letter added, dropped or changed) away; empty where none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// "a, b, c"
std::string join(const std::vector<std::string>&);

} // namespace talus::scenes
