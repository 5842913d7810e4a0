// SPDX-License-Identifier: MIT
#include "viewer/panels.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include "viewer/keys.h"

namespace talus::viewer {

namespace {

constexpr float k_width = 330.0f; // pixels of a usual screen

void show_time(Workbench& bench) {
    Session& session = bench.session;
    if (ImGui::Button(session.running ? "Pause" : "Run")) bench.toggle_running();
    ImGui::SameLine();
    if (ImGui::Button("Step")) bench.step();
    ImGui::SameLine();
    if (ImGui::Button("Back")) bench.step_back();
    ImGui::SameLine();
    if (ImGui::Button("Reset")) bench.reset();
    auto speed = static_cast<float>(session.speed);
    if (ImGui::SliderFloat("speed", &speed, 1.0f / 64.0f, 64.0f, "× %.3g", ImGuiSliderFlags_Logarithmic))
        session.speed = speed;
    ImGui::Text("step %llu, %.2f s, %.2f × real time", static_cast<unsigned long long>(session.world().step_count()),
                static_cast<double>(session.world().step_count()) * session.world().settings().dt,
                session.running ? session.achieved_speed() : 0.0);
    ImGui::Checkbox("keep snapshots to step back to", &session.keep_past);
}

void show_overlays(render::Overlays& overlays) {
    int number = 1;
    for (const render::OverlayInfo& overlay : render::list_overlays()) {
        ImGui::Checkbox(fmt::format("{} ({})", overlay.name, number++ % 10).c_str(), &(overlays.*overlay.shown));
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", overlay.meaning);
        if (number % 2 == 0) ImGui::SameLine(0.5f * ImGui::GetWindowWidth());
    }
}

void show_tools(Workbench& bench) {
    Projectile& thrown = bench.projectile;
    ImGui::SliderFloat("size, m", &thrown.size, 0.05f, 10.0f, "%.2f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    ImGui::SliderFloat("speed, m/s", &thrown.speed, 0.0f, 100.0f, "%.0f", ImGuiSliderFlags_AlwaysClamp);
    ImGui::SliderFloat("density, kg/m³", &thrown.density, 10.0f, 20000.0f, "%.0f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    ImGui::TextDisabled("B shoots a ball, X drops a box");
    if (ImGui::Button("Picture")) bench.save_picture();
    ImGui::SameLine();
    if (ImGui::Button(bench.display.is_recording() ? "End video" : "Video")) bench.toggle_video();
    ImGui::SameLine();
    if (ImGui::Button("Save snapshot")) bench.save_snapshot();
    ImGui::SameLine();
    if (ImGui::Button("Load")) bench.load_snapshot();
}

void show_message(const Workbench& bench) {
    std::string text = bench.message();
    if (bench.display.is_recording()) text = text.empty() ? "recording" : "recording - " + text;
    if (text.empty()) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float width = std::min(0.6f * screen.x, ImGui::CalcTextSize(text.c_str()).x + 2.0f * ImGui::GetFontSize());
    ImGui::SetNextWindowPos({screen.x - ImGui::GetFontSize(), screen.y - ImGui::GetFontSize()}, ImGuiCond_Always,
                            {1, 1});
    ImGui::SetNextWindowSize({width, 0.0f});
    ImGui::Begin("##message", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::End();
}

void show_help(Workbench& bench) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize({std::min(0.95f * screen.x, 52.0f * ImGui::GetFontSize()), 0.95f * screen.y});
    if (ImGui::Begin("Keys and mouse", &bench.show_help, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse)) {
        const auto rows = [](const auto& entries) {
            for (const auto& entry : entries) {
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(entry.name);
                ImGui::TableNextColumn();
                ImGui::TextWrapped("%s", entry.meaning);
            }
        };
        const auto table = [&](const char* name, const auto& entries, int pairs, float name_width) {
            if (!ImGui::BeginTable(name, 2 * pairs)) return;
            for (int i = 0; i < pairs; ++i) {
                ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, name_width * ImGui::GetFontSize());
                ImGui::TableSetupColumn("");
            }
            rows(entries);
            ImGui::EndTable();
        };
        table("mouse", list_gestures(), 1, 15.0f);
        ImGui::Separator();
        table("keys", list_keys(), 2, 4.0f);
    }
    ImGui::End();
}

} // namespace

std::uint32_t Panels::width(const Workbench& bench, float scale) {
    return bench.show_panels ? static_cast<std::uint32_t>(std::lround(k_width * scale)) : 0;
}

void Panels::show(Workbench& bench, float scale) {
    if (bench.show_panels) {
        const float height = ImGui::GetIO().DisplaySize.y;
        ImGui::SetNextWindowPos({0.0f, 0.0f});
        ImGui::SetNextWindowSize({static_cast<float>(width(bench, scale)), height});
        ImGui::Begin("##panels", nullptr, ImGuiWindowFlags_NoDecoration & ~ImGuiWindowFlags_NoScrollbar);
        ImGui::PushItemWidth(-9.0f * ImGui::GetFontSize());
        ImGui::TextWrapped("%s", bench.session.scene().name.c_str());
        ImGui::TextDisabled("F1: keys and mouse");
        show_time(bench);
        if (ImGui::CollapsingHeader("Scenes")) scene.show(bench);
        if (ImGui::CollapsingHeader("Device and solver")) show_settings_panel(bench);
        if (ImGui::CollapsingHeader("Show", ImGuiTreeNodeFlags_DefaultOpen)) show_overlays(bench.display.overlays);
        if (ImGui::CollapsingHeader("Throw in, keep")) show_tools(bench);
        if (ImGui::CollapsingHeader("Measurements", ImGuiTreeNodeFlags_DefaultOpen)) measurements.show(bench);
        ImGui::PopItemWidth();
        ImGui::End();
    }
    if (bench.show_help) show_help(bench);
    show_message(bench);
}

} // namespace talus::viewer
