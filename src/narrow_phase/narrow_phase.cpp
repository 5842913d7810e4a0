// SPDX-License-Identifier: MIT
// The launches of the narrow phase, in order.
#include "narrow_phase/narrow_phase.h"

#include "step.h"

namespace talus::engine {

void index_old_manifolds(Device& device) {
    device.run({.kernel = clear_pair_table, .slot = k_dispatch_table});
    device.run({.kernel = fill_pair_table, .slot = k_dispatch_old_pairs});
}

void narrow_phase(Device& device, const StepPlan& plan) {
    if (plan.search == Search::All || plan.watch != ContactWatch::None) index_old_manifolds(device);
    const std::initializer_list<Binding> list{
        {"UnsettledPairs", BufferId::Uncoloured}}; // nobody wants that before the graph
    if (plan.records_last) device.run({.kernel = list_unsettled_pairs, .slot = k_dispatch_pairs, .bindings = list});
    device.run({.kernel = collide_pairs,
                .slot = plan.records_last ? k_dispatch_unsettled_pairs : k_dispatch_pairs,
                .args = {plan.records_last},
                .bindings = list});
}

} // namespace talus::engine
