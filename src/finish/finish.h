// SPDX-License-Identifier: MIT
// Finish: contact events are reported, poses move on, and the step's results become the last step's.
#pragma once

#include "device/device.h"

namespace talus::engine {

struct StepPlan;

/// Swaps the manifolds at its end, also where the step did not fit.
void finish(Device&, const StepPlan&);
/// Manifolds, their points and the states of contacts change places with the old ones.
void swap_manifolds(Device&);

extern const Kernel gather_contact_impulses, report_contacts, report_contact_ends, weigh_sleepers, finish_bodies;

} // namespace talus::engine
