// SPDX-License-Identifier: MIT
// One line for each subject, with the subject in front.
#include "cli/summary.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "cli/words.h"

namespace talus::cli {
namespace {

std::string counted(std::uint64_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string row(std::string_view subject, std::string_view text) {
    return fmt::format("{:<12}{}\n", subject, text);
}

std::string body_text(const BodyCounts& bodies) {
    const std::string total = bodies.total == 1 ? "1 body" : fmt::format("{} bodies", bodies.total);
    return fmt::format("{}: {} dynamic, {} kinematic, {} static", total, bodies.dynamic, bodies.kinematic,
                       bodies.fixed);
}

std::string device_text(const DeviceInfo& device) {
    std::string text = fmt::format("{}: {}, {}", word_of(device_words(), device.kind), device.name, device.driver);
    if (device.threads > 0) text += ", " + counted(device.threads, "thread");
    return text;
}

std::string step_text(const RunReport& report) {
    const Settings& settings = report.settings;
    const bool soft = settings.stabilisation == Stabilisation::Soft;
    return fmt::format(
        "{} of {:.5g} ms: {}, {}{}{}, broad phase {}, {}", report.timing.steps, settings.dt * 1e3,
        word_of(stabilisation_words(), settings.stabilisation),
        soft ? counted(report.last_step.substeps, "sub-step") + " of " : "", counted(settings.iterations, "iteration"),
        settings.solve_order == SolveOrder::Coloured ? "" : " in sequential order",
        word_of(broad_phase_words(), report.last_step.broad_phase), counted(report.last_step.growths, "growth"));
}

std::string speed_text(const RunReport& report) {
    const Statistics times = statistics_of(report.timing.step_ms);
    return fmt::format("{:.1f} steps/s; ms a step: median {:.3f}, mean {:.3f}, 95 % within {:.3f}, longest {:.3f}",
                       report.steps_per_second(), times.median, times.mean, times.p95, times.max);
}

std::string contact_text(const StepReport& step) {
    std::string text = fmt::format("{}, {}, {}, {}", counted(step.pairs, "pair"), counted(step.manifolds, "manifold"),
                                   counted(step.contacts, "contact point"), counted(step.colours, "colour"));
    if (step.overflow_manifolds > 0)
        text += fmt::format(" and {} without one", counted(step.overflow_manifolds, "manifold"));
    if (step.hubs > 0) text += ", " + counted(step.hubs, "hub");
    return text;
}

std::string stage_rows(const std::vector<double>& stage_ms) {
    const double total = std::accumulate(stage_ms.begin(), stage_ms.end(), 0.0);
    std::string rows;
    const std::span<const char* const> names = stage_names();
    for (std::size_t i = 0; i < std::min(names.size(), stage_ms.size()); ++i)
        rows += row(i == 0 ? "stages" : "", fmt::format("{:<18}{:>9.3f} ms {:>5.1f} %", names[i], stage_ms[i],
                                                        total > 0.0 ? 100.0 * stage_ms[i] / total : 0.0));
    return rows;
}

} // namespace

std::string length_text(double metres) {
    if (metres < 0.1) return fmt::format("{:.3g} mm", metres * 1e3);
    return fmt::format("{:.4g} m", metres);
}

std::string summary_of(const RunReport& report, bool stages) {
    const Quality& quality = report.quality;
    std::string text;
    text += row("scene", fmt::format("{} ({})", report.scene, body_text(report.bodies)));
    text += row("device", device_text(report.device));
    if (!report.device.why.empty()) text += row("", report.device.why);
    text += row("steps", step_text(report));
    text += row("speed", speed_text(report));
    if (stages) text += stage_rows(report.timing.stage_ms);
    text += row("contacts", contact_text(report.last_step));
    text += row("overlap", fmt::format("largest {}, mean {} of {}", length_text(quality.max_penetration),
                                       length_text(quality.mean_penetration),
                                       counted(quality.overlapping_pairs, "overlapping pair")));
    text += row("drift", fmt::format("largest {}, sideways {}", length_text(quality.max_drift),
                                     length_text(quality.max_drift_sideways)));
    text += row("motion", fmt::format("kinetic energy {:.4g} J, largest speed {:.4g} m/s", quality.kinetic_energy,
                                      quality.max_speed));
    text += row("bodies",
                fmt::format("{} escaped, {} not finite{}", quality.escaped_bodies, report.nonfinite_bodies(),
                            report.settings.sleeping ? fmt::format(", {} asleep", report.last_step.sleeping_bodies)
                                                     : std::string()));
    text += row("memory", fmt::format("{:.1f} MiB on the device, {:.1f} MiB on the host",
                                      static_cast<double>(report.memory.device) / (1 << 20),
                                      static_cast<double>(report.memory.host) / (1 << 20)));
    text += row("state hash", hash_text(report.state_hash));
    return text;
}

} // namespace talus::cli
