// SPDX-License-Identifier: MIT
// From the device's contact reports to the events of the public interface.
#pragma once

#include <vector>

#include <talus/types.h>

#include "body_table.h"
#include "simulation.h"

namespace talus::engine {

/// Appends one step's events in the order of the bodies' indices. The table must still know who was in which slot then.
void append_events(std::vector<ContactEvent>&, Simulation::StepReports&, const BodyTable&);

} // namespace talus::engine
