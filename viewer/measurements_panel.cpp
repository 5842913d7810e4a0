// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include "cli/timed_run.h"
#include "render/overlay_lines.h"
#include "viewer/panels.h"

namespace talus::viewer {

namespace {

void plot(const char* name, const Curve& curve, const std::string& newest, float least = 0.0f) {
    const float height = 2.2f * ImGui::GetTextLineHeight();
    const float most = std::max(curve.largest(), least + 1.0e-6f);
    ImGui::PlotLines(fmt::format("##{}", name).c_str(), curve.values().data(), static_cast<int>(curve.values().size()),
                     0, fmt::format("{}: {}", name, newest).c_str(), least, most,
                     {ImGui::GetContentRegionAvail().x, height});
}

ImVec4 colour_of_stage(std::size_t stage) {
    const glm::vec3 colour = render::colour_of_number(static_cast<std::uint32_t>(stage));
    return {colour.x, colour.y, colour.z, 1.0f};
}

/// The last steps, a column each: the times of their stages on top of each other.
void plot_stages(const Measurements& m) {
    const ImVec2 size{ImGui::GetContentRegionAvail().x, 4.0f * ImGui::GetTextLineHeight()};
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy(size);
    ImDrawList& graph = *ImGui::GetWindowDrawList();
    graph.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const std::size_t steps = m.step_ms.values().size();
    const float width = size.x / static_cast<float>(steps);
    const std::vector<double> times(m.step_ms.values().begin(), m.step_ms.values().end());
    // A step that took very long once is cut off: else all others would be flat.
    const float most = std::max(2.5f * static_cast<float>(cli::statistics_of(times).median), 1.0e-6f);
    for (std::size_t step = 0; step < steps; ++step) {
        const float left = corner.x + width * static_cast<float>(step);
        float below = corner.y + size.y;
        for (std::size_t stage = 0; stage < m.stage_ms.size(); ++stage) {
            const float top = std::max(corner.y, below - size.y * m.stage_ms[stage].values()[step] / most);
            graph.AddRectFilled({left, top}, {left + width, below},
                                ImGui::ColorConvertFloat4ToU32(colour_of_stage(stage)));
            below = top;
        }
    }
    const std::string title = fmt::format("step: {:.2f} ms", m.step_ms.newest());
    graph.AddText({corner.x + 0.5f * (size.x - ImGui::CalcTextSize(title.c_str()).x), corner.y},
                  ImGui::GetColorU32(ImGuiCol_Text), title.c_str());
    const float letter = ImGui::GetFontSize();
    for (std::size_t stage = 0; stage < m.stage_ms.size(); ++stage) {
        ImGui::ColorButton(stage_names()[stage], colour_of_stage(stage), ImGuiColorEditFlags_NoTooltip,
                           {letter, letter});
        ImGui::SameLine();
        ImGui::Text("%s  %.2f ms", stage_names()[stage], m.stage_ms[stage].mean());
    }
}

std::string count(const Curve& curve) {
    return fmt::format("{:.0f}", curve.newest());
}

std::string energy(float joules) {
    return joules >= 1.0e6f   ? fmt::format("{:.2f} MJ", joules * 1.0e-6f)
           : joules >= 1.0e3f ? fmt::format("{:.2f} kJ", joules * 1.0e-3f)
                              : fmt::format("{:.2f} J", joules);
}

std::string megabytes(std::uint64_t bytes) {
    return fmt::format("{:.1f} MB", 1.0e-6 * static_cast<double>(bytes));
}

} // namespace

void MeasurementsPanel::show(const Workbench& bench) {
    const Session& session = bench.session;
    measurements.update(session.world());
    const Measurements& m = measurements;
    plot_stages(m);
    plot("pairs", m.pairs, count(m.pairs));
    plot("contact points", m.contacts, count(m.contacts));
    plot("colours", m.colours, count(m.colours));
    plot("sub-steps", m.substeps, count(m.substeps));
    plot("kinetic energy", m.kinetic, energy(m.kinetic.newest()));
    const float lowest = m.total.values().empty() ? 0.0f : *std::ranges::min_element(m.total.values());
    plot("total energy", m.total, energy(m.total.newest()), lowest);
    ImGui::Text("memory: device %s, host %s", megabytes(m.memory.device).c_str(), megabytes(m.memory.host).c_str());
    ImGui::Text("snapshots: %zu, %s, back to step %llu", session.history().size(),
                megabytes(session.history().bytes()).c_str(),
                static_cast<unsigned long long>(session.history().first_step(session.world())));
}

} // namespace talus::viewer
