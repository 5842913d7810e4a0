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

Parameter real(const char* name, double default_value, double minimum, double maximum, const char* meaning) {
    return {name, default_value, minimum, maximum, false, meaning};
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
        {{"grid", "separate stacks of 5 boxes", {whole("stacks", 4000, 1, 400'000, "how many stacks")}}, make_grid},
        {{"pile",
          "boxes with edges of 0.5 to 1.5 m fall into a container",
          {whole("boxes", 32000, 1, 1'000'000, "how many boxes"), seed()}},
         make_pile},
        {{"rubble",
          "boxes of very different sizes fall into a container, the smallest with edges of 1/8 m",
          {whole("boxes", 32000, 1, 1'000'000, "how many boxes"),
           real("ratio", 32, 1, 1000, "the longest edge over the shortest, at most"), seed()}},
         make_rubble},
        {{"card_house", "a house of cards", {whole("levels", 5, 1, 30, "storeys")}}, make_card_house},
        {{"dominoes",
          "a row of dominoes, of which the first is falling",
          {whole("count", 100, 1, 10'000, "how many dominoes"),
           real("bend", 30, 0, 60, "how far the row swings from its line to each side, in degrees")}},
         make_dominoes},
        {{"slope",
          "boxes on a tilted plate",
          {real("angle", 20, 0, 60, "of the plate, in degrees"), real("friction", 0.5, 0, 10, "of boxes and plate"),
           whole("boxes", 10, 1, 1000, "how many boxes")}},
         make_slope},
        {{"plate",
          "a heavy plate that lies on a grid of boxes and carries as many",
          {whole("boxes", 2000, 1, 100'000, "boxes below the plate, and as many on it")}},
         make_plate},
        {{"heavy_on_light",
          "boxes that carry boxes of the same size and 1, 10, 100 ... times the mass, up to a ratio",
          {real("ratio", 1000, 1, 1'000'000, "the largest mass carried, in masses of the box below")}},
         make_heavy_on_light},
        {{"brick_ring",
          "a round wall of bricks, hit from inside by a rolling steel sphere",
          {whole("courses", 40, 1, 80, "bricks on top of each other; the wall is one deeper for each four"),
           whole("radius", 80, 20, 200, "of the inside, in metres")}},
         make_brick_ring},
        {{"brick_gables",
          "rows of triangular brick walls and two steel spheres that roll through them",
          {whole("across", 16, 1, 20, "walls side by side in a row"), whole("rows", 68, 1, 80, "rows of walls"),
           whole("base", 30, 1, 35, "bricks in the lowest course of a wall")}},
         make_brick_gables},
        {{"many_pyramids",
          "a square field of pyramids, each one box deep",
          {whole("side", 14, 1, 30, "pyramids along each side"), whole("base", 10, 1, 40, "boxes in a lowest row")}},
         make_many_pyramids},
        {{"million",
          "the pile with a million boxes",
          {whole("boxes", 1'000'000, 1, 1'000'000, "how many boxes"), seed()}},
         make_pile},
        {{"worlds",
          "many small worlds, each a block of columns four wide and four deep",
          {whole("count", 64, 1, 10'000, "how many worlds"), whole("boxes", 64, 1, 160, "boxes in each")}},
         make_worlds},
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
