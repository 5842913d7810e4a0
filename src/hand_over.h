// SPDX-License-Identifier: MIT
// What passes between two devices, one of which keeps its buffers in the host's memory. In a hybrid step (thesis,
// section 4.2) the device of the resolution holds the state; the one of the detection borrows it.
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

/// Where bodies are, and were before the last step, to be drawn.
void hand_over_places(Device& from, Device& to, uint slots);

/// How much there is of a state.
struct StateCounts {
    uint slots = 0; ///< of bodies
    uint pairs = 0;
};

/// All that is drawn: bodies, and the last step's contacts, to a device that has room for them. Nothing is to be on its
/// way.
void hand_over_drawn(Device& from, Device& to, StateCounts);
/// All that a step has left for the next one, in the same way. Constraints stay.
void hand_over_state(Device& from, Device& to, StateCounts);

} // namespace talus::engine
