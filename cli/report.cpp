// SPDX-License-Identifier: MIT
// Every key is there in every report; what was not measured is null.
#include "cli/report.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/words.h"

namespace talus::cli {
namespace {

using Json = nlohmann::ordered_json;

BodyCounts count_bodies(std::span<const BodySample> bodies) {
    BodyCounts counts;
    counts.total = bodies.size();
    for (const BodySample& body : bodies) {
        if (body.kind == BodyKind::Rigid) ++counts.dynamic;
        if (body.kind == BodyKind::Kinematic) ++counts.kinematic;
        if (body.kind == BodyKind::Static) ++counts.fixed;
    }
    return counts;
}

Json step_times(const Statistics& times) {
    return {{"median", times.median}, {"mean", times.mean}, {"p95", times.p95}, {"max", times.max}};
}

Json stage_times(const std::vector<double>& stage_ms) {
    Json stages = Json::object();
    const std::span<const char* const> names = stage_names();
    for (std::size_t i = 0; i < names.size(); ++i)
        stages[names[i]] = i < stage_ms.size() ? Json(stage_ms[i]) : Json(nullptr);
    return stages;
}

Json quality_figures(const RunReport& report) {
    const Quality& quality = report.quality;
    return {{"max_penetration", quality.max_penetration},
            {"mean_penetration", quality.mean_penetration},
            {"max_drift", quality.max_drift},
            {"max_drift_sideways", quality.max_drift_sideways},
            {"kinetic_energy", quality.kinetic_energy},
            {"max_speed", quality.max_speed},
            {"linear_momentum", quality.linear_momentum},
            {"angular_momentum", quality.angular_momentum},
            {"nonfinite_bodies", report.nonfinite_bodies()},
            {"escaped_bodies", quality.escaped_bodies}};
}

} // namespace

std::uint64_t RunReport::nonfinite_bodies() const {
    return std::max<std::uint64_t>(quality.nonfinite_bodies, last_step.frozen_bodies);
}

double RunReport::steps_per_second() const {
    return timing.seconds > 0.0 ? static_cast<double>(timing.timed_steps) / timing.seconds : 0.0;
}

RunReport make_report(const TimedRun& run) {
    const World& world = run.world();
    const std::vector<BodySample> bodies = sample_bodies(world);
    std::vector<Vec3> starts;
    starts.reserve(run.scene().bodies.size());
    for (const scenes::NamedBody& body : run.scene().bodies)
        starts.push_back(body.definition.pose.position);

    RunReport report;
    report.scene = run.scene().name;
    report.device = world.device();
    report.settings = world.settings();
    report.bodies = count_bodies(bodies);
    report.last_step = world.report();
    report.timing = run.timing();
    report.quality = measure_quality(bodies, starts, run.scene().bounds);
    report.memory = world.memory();
    report.state_hash = world.state_hash();
    return report;
}

Json to_json(const RunReport& report) {
    return {
        {"scene", report.scene},
        {"device",
         {{"kind", word_of(device_words(), report.device.kind)},
          {"name", report.device.name},
          {"driver", report.device.driver}}},
        {"threads", report.device.threads},
        {"steps", report.timing.steps},
        {"dt", report.settings.dt},
        {"substeps", report.last_step.substeps},
        {"iterations", report.settings.iterations},
        {"stabilisation", word_of(stabilisation_words(), report.settings.stabilisation)},
        {"solve_order", word_of(solve_order_words(), report.settings.solve_order)},
        {"broad_phase", word_of(broad_phase_words(), report.last_step.broad_phase)},
        {"sleeping", report.settings.sleeping},
        {"bodies",
         {{"total", report.bodies.total},
          {"dynamic", report.bodies.dynamic},
          {"kinematic", report.bodies.kinematic},
          {"static", report.bodies.fixed},
          {"sleeping", report.last_step.sleeping_bodies}}},
        {"pairs", report.last_step.pairs},
        {"manifolds", report.last_step.manifolds},
        {"contacts", report.last_step.contacts},
        {"colours", report.last_step.colours},
        {"step_ms", step_times(statistics_of(report.timing.step_ms))},
        {"steps_per_second", report.steps_per_second()},
        {"stages_ms", stage_times(report.timing.stage_ms)},
        {"growths", report.last_step.growths},
        {"quality", quality_figures(report)},
        {"memory_bytes", {{"device", report.memory.device}, {"host", report.memory.host}}},
        {"state_hash", hash_text(report.state_hash)},
    };
}

std::string hash_text(std::uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

} // namespace talus::cli
