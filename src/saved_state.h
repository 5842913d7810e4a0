// SPDX-License-Identifier: MIT
// What a Snapshot holds: the buffers of the role State, the host's table of bodies, and the results of the last step
// that a caller may ask for.
#pragma once

#include <array>
#include <vector>

#include <talus/world.h>

#include "body_table.h"
#include "simulation.h"

namespace talus::engine {

struct SavedState {
    Settings settings;
    StepReport report;
    BodyTable table; ///< with the poses and velocities of the report's step, and the caller's changes since
    std::array<uint, k_counter_words> counters{};
    std::vector<Manifold> manifolds;           ///< one a pair
    std::vector<ManifoldPoint> points;         ///< of the manifolds in turn, as many as each has
    std::vector<Separations> separations;      ///< one a manifold
    std::vector<NormalImpulses> next_impulses; ///< one a manifold: what the next step starts from
    std::vector<float> impulses;               ///< N·s along the normal, one a point: of the whole step, hits included
    std::vector<uint> contact_states;          ///< k_contact_*, one a pair; empty where no contacts were watched
    std::vector<BodyStart> starts;             ///< one a body slot
    std::vector<BodyRest> rests;               ///< one a body slot; empty where nothing may sleep
    std::vector<OrientedBox> boxes;            ///< one a body slot of the last search for pairs

    std::size_t bytes() const;
};

/// `table` must be fresh. Waits for the last step.
SavedState save_state(Simulation&, const BodyTable& table, const Settings&);

} // namespace talus::engine
