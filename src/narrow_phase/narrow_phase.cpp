// SPDX-License-Identifier: MIT
// The launches of the narrow phase, in order.
#include "narrow_phase/narrow_phase.h"

#include "step.h"

namespace talus::engine {

void index_old_manifolds(Device& device) {
    device.run({.kernel = clear_pair_table, .slot = k_dispatch_table});
    device.run({.kernel = fill_pair_table, .slot = k_dispatch_old_pairs});
}

void forget_changed_turns(Device& device, uint count) {
    device.run({.kernel = forget_turns, .items = count, .args = {count}});
}

void narrow_phase(Device& device, const StepPlan& plan) {
    if (plan.search == Search::All || plan.watch != ContactWatch::None) index_old_manifolds(device);
    const std::initializer_list<Binding> list{
        {"PairsToCollide", BufferId::Uncoloured}}; // nobody wants that before the graph
    device.run({.kernel = renew_contacts,
                .slot = k_dispatch_pairs,
                .args = {plan.records_last, plan.collides_early},
                .bindings = list});
    device.run({.kernel = collide_pairs, .slot = k_dispatch_pairs, .bindings = list});
}

} // namespace talus::engine
