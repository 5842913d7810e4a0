// SPDX-License-Identifier: MIT
#include "contact_events.h"

#include <algorithm>
#include <utility>

namespace talus::engine {
namespace {

ContactPhase phase_of(const ContactReport& report) {
    switch (report.phase) {
    case k_phase_begin:
        return ContactPhase::Begin;
    case k_phase_persist:
        return ContactPhase::Persist;
    default:
        return ContactPhase::End;
    }
}

} // namespace

void append_events(std::vector<ContactEvent>& events, Simulation::StepReports& step, const BodyTable& table) {
    // A pair has one report a step: the order is complete.
    std::ranges::sort(step.reports, {}, [](const ContactReport& r) { return std::pair(r.body_a, r.body_b); });
    events.reserve(events.size() + step.reports.size());
    for (const ContactReport& report : step.reports) {
        ContactEvent& event = events.emplace_back();
        event.step = step.step;
        event.phase = phase_of(report);
        event.a = table.last_id_of(report.body_a);
        event.b = table.last_id_of(report.body_b);
        event.sensor = report.sensor != 0;
        event.normal = from_glm(report.normal);
        for (int i = 0; i < static_cast<int>(report.point_count); ++i)
            event.points.push_back(
                {{report.x[i], report.y[i], report.z[i]}, report.separation[i], report.normal_impulse[i]});
    }
}

} // namespace talus::engine
