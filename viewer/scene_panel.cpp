// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "scenes/parameters.h"
#include "viewer/panels.h"

namespace talus::viewer {

namespace {

bool matches(const scenes::SceneInfo& scene, const std::string& search) {
    const auto contains = [&search](const std::string& text) {
        const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
        return std::search(text.begin(), text.end(), search.begin(), search.end(), same) != text.end() ||
               search.empty();
    };
    return contains(scene.name) || contains(scene.summary);
}

void edit_parameter(const scenes::Parameter& parameter, double& value) {
    const char* name = parameter.name.c_str();
    // Over many powers of ten a slider goes by them.
    const bool wide = parameter.minimum > 0.0 && parameter.maximum / parameter.minimum > 1000.0;
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0);
    if (parameter.integer && parameter.maximum > 2.0e9) {
        ImGui::InputScalar(name, ImGuiDataType_Double, &value, nullptr, nullptr, "%.0f");
        value = std::clamp(std::floor(value), parameter.minimum, parameter.maximum);
    } else if (parameter.integer) {
        int whole = static_cast<int>(value);
        ImGui::SliderInt(name, &whole, static_cast<int>(parameter.minimum), static_cast<int>(parameter.maximum), "%d",
                         flags);
        value = whole;
    } else {
        ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &parameter.minimum, &parameter.maximum, "%.3g", flags);
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", parameter.meaning.c_str());
}

} // namespace

void ScenePanel::choose(const scenes::SceneInfo& scene, std::string_view parameters) {
    const scenes::Parameters given(scene, parameters);
    chosen = &scene;
    values.clear();
    for (const scenes::Parameter& parameter : scene.parameters)
        values.push_back(given.value_of(parameter.name));
}

void ScenePanel::follow(const std::string& name) {
    if (name == followed) return;
    followed = name;
    chosen = nullptr;
    const std::size_t end = std::min(name.find(':'), name.size());
    const auto scene = std::ranges::find(scenes::list_scenes(), name.substr(0, end), &scenes::SceneInfo::name);
    if (scene != scenes::list_scenes().end())
        choose(*scene, std::string_view(name).substr(std::min(end + 1, name.size())));
}

std::string ScenePanel::specification() const {
    std::string text = chosen->name;
    for (std::size_t i = 0; i < values.size(); ++i)
        text += fmt::format("{}{}={}", i == 0 ? ":" : ",", chosen->parameters[i].name, values[i]);
    return text;
}

void ScenePanel::show(Workbench& bench) {
    follow(bench.session.scene().name);
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::InputTextWithHint("##search", "search a scene; Enter opens the first", &search,
                                 ImGuiInputTextFlags_EnterReturnsTrue)) {
        const auto& all = scenes::list_scenes();
        const auto first = std::ranges::find_if(all, [&](const auto& scene) { return matches(scene, search); });
        if (first != all.end()) {
            if (chosen != &*first) choose(*first);
            bench.open(specification());
        }
    }
    if (ImGui::BeginListBox("##scenes", {-1.0f, 7.5f * ImGui::GetTextLineHeightWithSpacing()})) {
        for (const scenes::SceneInfo& scene : scenes::list_scenes()) {
            if (!matches(scene, search)) continue;
            if (ImGui::Selectable(scene.name.c_str(), chosen == &scene, ImGuiSelectableFlags_AllowDoubleClick)) {
                if (chosen != &scene) choose(scene);
                if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) bench.open(specification());
            }
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", scene.summary.c_str());
        }
        ImGui::EndListBox();
    }
    if (chosen != nullptr) {
        ImGui::TextWrapped("%s", chosen->summary.c_str());
        for (std::size_t i = 0; i < values.size(); ++i)
            edit_parameter(chosen->parameters[i], values[i]);
        if (ImGui::Button("Open")) bench.open(specification());
        ImGui::SameLine();
    }
    if (ImGui::Button("Random seed")) bench.reseed();
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::InputTextWithHint("##path", "a file (.gltf, .glb, .snapshot), or drop one here", &path,
                                 ImGuiInputTextFlags_EnterReturnsTrue))
        bench.open(path);
}

} // namespace talus::viewer
