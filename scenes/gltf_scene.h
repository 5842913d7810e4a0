// SPDX-License-Identifier: MIT
// Scenes from glTF files with the extensions KHR_physics_rigid_bodies and KHR_implicit_shapes.
#pragma once

#include <string_view>

#include "scenes/scene.h"

namespace talus::scenes {

/// Boxes and spheres, static, rigid and kinematic. Throws Error, naming the file, the node and the reason, for a file
/// that is broken and for one that would move wrongly without what Talus does not have (other shapes, compounds,
/// joints, filters). What is left out without harm (triggers) is listed in the scene's warnings.
Scene read_gltf_scene(std::string_view path);

} // namespace talus::scenes
