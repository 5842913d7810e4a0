// SPDX-License-Identifier: MIT
// The launches that end a step, in order.
#include "finish/finish.h"

#include "step.h"

namespace talus::engine {

static void report_events(Device& device, const StepPlan& plan) {
    const uint persisting = plan.watch == ContactWatch::All ? 1 : 0;
    device.run({.kernel = gather_contact_impulses, .slot = k_dispatch_ordered_pairs});
    device.run({.kernel = report_contacts, .slot = k_dispatch_reports, .args = {persisting, plan.report_room}});
    device.run({.kernel = report_contact_ends, .slot = k_dispatch_report_ends, .args = {persisting, plan.report_room}});
}

void finish(Device& device, const StepPlan& plan) {
    if (plan.watch != ContactWatch::None) report_events(device, plan);
    if (plan.sleeps_in_parts()) device.run({.kernel = weigh_sleepers, .slot = k_dispatch_graph_pairs});
    device.run({.kernel = finish_bodies,
                .slot = k_dispatch_bodies,
                .args = {plan.sleeps_in_parts(), plan.records_last, plan.loads}});
    swap_manifolds(device);
}

void swap_manifolds(Device& device) {
    device.swap_contacts();
    device.swap(BufferId::ContactStates, BufferId::OldContactStates);
}

} // namespace talus::engine
