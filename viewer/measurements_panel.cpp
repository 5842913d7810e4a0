// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

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
    plot("step", m.step_ms, fmt::format("{:.2f} ms", m.step_ms.newest()));
    double sum = 0.0;
    for (const double ms : m.stage_ms)
        sum += ms;
    const float letters = ImGui::GetTextLineHeight();
    for (std::size_t i = 0; i < m.stage_ms.size(); ++i) {
        const float share = sum > 0.0 ? static_cast<float>(m.stage_ms[i] / sum) : 0.0f;
        ImGui::ProgressBar(share, {6.0f * letters, letters}, "");
        ImGui::SameLine();
        ImGui::Text("%s  %.2f ms", stage_names()[i], m.stage_ms[i]);
    }
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
