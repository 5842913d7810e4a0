// SPDX-License-Identifier: MIT
// Narrow phase: candidate pairs -> manifolds of at most four points, with the last step's impulses (thesis,
// section 3.3).
#pragma once

#include "device/device.h"

namespace talus::engine {

struct StepPlan;

/// Fills Manifolds, PointSeparations and PointImpulses, one a pair, and ManifoldPoints, four.
void narrow_phase(Device&, const StepPlan&);
/// Fills PairTable from OldManifolds, which narrow_phase does too.
void index_old_manifolds(Device&);

/// Of the bodies that the first `count` words of Changes name: none of their contacts lasts.
void forget_changed_turns(Device&, uint count);

extern const Kernel clear_pair_table;
extern const Kernel fill_pair_table;
extern const Kernel forget_turns;
extern const Kernel renew_contacts;
extern const Kernel collide_pairs;

} // namespace talus::engine
