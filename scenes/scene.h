// SPDX-License-Identifier: MIT
// A scene: bodies with names, where they belong, and how to look at them. One source for the command line, the tests
// and the benchmarks.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <talus/talus.h>

namespace talus::scenes {

struct NamedBody {
    std::string name;
    BodyDefinition definition;
};

/// An axis-aligned region (m).
struct Bounds {
    Vec3 lower, upper;
};

/// A perspective camera that looks from `eye` at `target`, y up.
struct Camera {
    Vec3 eye{6.0f, 4.0f, 8.0f};
    Vec3 target;
    float vertical_fov = 0.7f; ///< rad
};

struct Scene {
    std::string name; ///< with its parameters, as it can be given again: "stack:height=30"
    std::vector<NamedBody> bodies;
    Bounds bounds; ///< a dynamic body whose centre leaves them has escaped
    Camera camera;
    Settings settings;                 ///< the scene's wishes (gravity); the command line's options go on top
    std::vector<std::string> warnings; ///< of a file: what is in it that is not supported, one line a kind
};

/// A parameter of a built-in scene.
struct Parameter {
    std::string name;
    double default_value = 0.0;
    double minimum = 0.0, maximum = 0.0;
    bool integer = true;
    std::string meaning;
};

struct SceneInfo {
    std::string name;
    std::string summary;
    std::vector<Parameter> parameters;
};

/// The built-in scenes, in the order in which they are listed.
const std::vector<SceneInfo>& list_scenes();

/// A built-in scene ("pool:boxes=200,seed=3") or a file (.gltf, .glb). Throws Error for an unknown scene (names the
/// nearest known ones), an unknown parameter, a value out of range, or a broken file.
Scene make_scene(std::string_view specification);

} // namespace talus::scenes
