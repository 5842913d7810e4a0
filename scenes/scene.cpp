// SPDX-License-Identifier: MIT
// From a specification to a scene: the table of built-in scenes, and the way to files.
#include "scenes/scene.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "scenes/builders.h"
#include "scenes/gltf_scene.h"
#include "scenes/parameters.h"

namespace talus::scenes {

namespace {

struct BuiltIn {
    SceneInfo info;
    Scene (*make)(const Parameters&);
};

Parameter whole(const char* name, double default_value, double minimum, double maximum, const char* meaning) {
    return {name, default_value, minimum, maximum, true, meaning};
}

Parameter seed() {
    return whole("seed", 1, 0, 4294967295.0, "chooses the random numbers");
}

const std::vector<BuiltIn>& built_in_scenes() {
    static const std::vector<BuiltIn> scenes{
        {{"stack", "one column of boxes", {whole("height", 10, 1, 1000, "boxes on top of each other")}}, make_stack},
        {{"pool",
          "boxes fall into an open box of walls",
          {whole("boxes", 1000, 1, 1'000'000, "how many boxes"), seed()}},
         make_pool},
        {{"extreme_stack",
          "tall stacks, walls, bridges, towers and pyramids side by side",
          {whole("height", 14, 6, 40, "boxes in the tallest stack")}},
         make_extreme_stack},
        {{"pyramid", "a pyramid, one box deep", {whole("base", 20, 1, 1000, "boxes in the lowest row")}}, make_pyramid},
        {{"wall",
          "a wall in running bond",
          {whole("width", 40, 1, 1000, "boxes in a row"), whole("height", 20, 1, 200, "rows")}},
         make_wall},
        {{"columns",
          "a square field of columns, 2 m apart",
          {whole("side", 100, 1, 300, "columns along each side"), whole("height", 10, 1, 50, "boxes in a column")}},
         make_columns},
        {{"grid", "separate stacks of 5 boxes", {whole("stacks", 4000, 1, 200'000, "how many stacks")}}, make_grid},
        {{"pile",
          "boxes with edges of 0.5 to 1.5 m fall into a container",
          {whole("boxes", 32000, 1, 1'000'000, "how many boxes"), seed()}},
         make_pile},
    };
    return scenes;
}

/// Lower-case, with its dot; empty where there is none.
std::string file_ending(std::string_view specification) {
    std::string ending = std::filesystem::path(specification).extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

[[noreturn]] void refuse_unknown(const std::string& name) {
    std::vector<std::string> names;
    for (const BuiltIn& scene : built_in_scenes())
        names.push_back(scene.info.name);
    const std::string nearest = nearest_name(name, names);
    throw Error("unknown scene '" + name + "'" + (nearest.empty() ? ". " : "; did you mean '" + nearest + "'? ") +
                "The scenes are: " + join(names) + "; or give a file (.gltf, .glb).");
}

} // namespace

const std::vector<SceneInfo>& list_scenes() {
    static const std::vector<SceneInfo> infos = [] {
        std::vector<SceneInfo> result;
        for (const BuiltIn& scene : built_in_scenes())
            result.push_back(scene.info);
        return result;
    }();
    return infos;
}

Scene make_scene(std::string_view specification) {
    const std::string ending = file_ending(specification);
    if (ending == ".gltf" || ending == ".glb") return read_gltf_scene(specification);

    const std::size_t colon = specification.find(':');
    const std::string name(specification.substr(0, colon));
    for (const BuiltIn& scene : built_in_scenes()) {
        if (scene.info.name != name) continue;
        const Parameters parameters(scene.info, colon == std::string_view::npos ? "" : specification.substr(colon + 1));
        Scene result = scene.make(parameters);
        const std::string text = parameters.text();
        result.name = name + (text.empty() ? "" : ":" + text);
        return result;
    }

    std::error_code ignored;
    const bool is_path = !ending.empty() || name.find('/') != std::string::npos;
    if (is_path || std::filesystem::exists(specification, ignored))
        throw Error("cannot read '" + std::string(specification) + "' as a scene: its name must end in .gltf or .glb" +
                    (ending.empty() ? "" : ", not in " + ending));
    refuse_unknown(name);
}

} // namespace talus::scenes
