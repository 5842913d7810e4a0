// SPDX-License-Identifier: MIT
// What passes between the two devices of a hybrid step (thesis, section 4.2). The device of the resolution holds the
// state; the one of the detection borrows it.
#pragma once

#include "device/device.h"

namespace talus::engine {

struct StepPlan;

/// Counters, before all else: whether the step before has fitted.
void hand_over_counters(Device& from, Device& to);
/// Poses and velocities, before the broad phase.
void hand_over_bodies(Device& from, Device& to, const StepPlan&);
/// Counters, launches and manifolds, after the narrow phase. Waits for it.
void hand_over_manifolds(Device& from, Device& to);
/// The solved manifolds, to be the next step's old ones.
void hand_over_impulses(Device& from, Device& to);

} // namespace talus::engine
