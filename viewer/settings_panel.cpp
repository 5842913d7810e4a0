// SPDX-License-Identifier: MIT
#include <algorithm>

#include <imgui.h>

#include "cli/words.h"
#include "viewer/panels.h"

namespace talus::viewer {

namespace {

/// A choice among words; true where another was taken.
template <typename T> bool choose(const char* label, T& value, cli::Words<T> words) {
    bool changed = false;
    if (!ImGui::BeginCombo(label, std::string(cli::word_of(words, value)).c_str())) return false;
    for (const auto& [word, meaning] : words) {
        if (ImGui::Selectable(std::string(word).c_str(), meaning == value) && meaning != value) {
            value = meaning;
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

bool edit(const char* label, std::uint32_t& value, int least, int most) {
    int whole = static_cast<int>(value);
    if (!ImGui::SliderInt(label, &whole, least, most, "%d", ImGuiSliderFlags_Logarithmic)) return false;
    value = static_cast<std::uint32_t>(std::clamp(whole, least, most));
    return true;
}

bool edit(const char* label, float& value, float least, float most, const char* format, ImGuiSliderFlags flags = 0) {
    return ImGui::SliderFloat(label, &value, least, most, format, flags | ImGuiSliderFlags_AlwaysClamp);
}

} // namespace

void show_settings_panel(Workbench& bench) {
    const World& world = bench.session.world();
    DeviceKind device = bench.session.device();
    if (choose("device", device, cli::device_words())) bench.move_to(device);
    ImGui::TextWrapped("%s", world.device().name.c_str());

    Settings settings = world.settings();
    bool changed = choose("broad phase", settings.broad_phase, cli::broad_phase_words());
    changed |= choose("solve order", settings.solve_order, cli::solve_order_words());
    if (choose("stabilisation", settings.stabilisation, cli::stabilisation_words())) {
        // As on the command line: Baumgarte's bias wants passes where soft contacts want sub-steps.
        settings.iterations = settings.stabilisation == Stabilisation::Baumgarte ? 10 : Settings{}.iterations;
        changed = true;
    }
    if (settings.stabilisation == Stabilisation::Soft) {
        changed |= edit("sub-steps, least", settings.substeps, 1, 256);
        changed |= edit("sub-steps, most", settings.max_substeps, 1, 256);
        settings.max_substeps = std::max(settings.max_substeps, settings.substeps);
        changed |= edit("contact, Hz", settings.contact_hertz, 1.0f, 5000.0f, "%.0f", ImGuiSliderFlags_Logarithmic);
        changed |= edit("damping ratio", settings.contact_damping_ratio, 0.0f, 50.0f, "%.1f");
    } else {
        changed |= edit("Baumgarte's β", settings.baumgarte, 0.0f, 1.0f, "%.2f");
    }
    changed |= edit("passes", settings.iterations, 1, 200);
    changed |= edit("step, s", settings.dt, 1.0f / 1000.0f, 1.0f / 20.0f, "%.4f", ImGuiSliderFlags_Logarithmic);
    changed |= edit("gravity, m/s²", settings.gravity.y, -30.0f, 30.0f, "%.2f");
    changed |= ImGui::Checkbox("islands may sleep", &settings.sleeping);
    if (changed) bench.set_settings(settings);
}

} // namespace talus::viewer
