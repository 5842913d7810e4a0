// SPDX-License-Identifier: MIT
// What a caller may ask about the last step: its pairs and contacts, as they lie in the buffers.
#pragma once

#include <vector>

#include "simulation.h"

namespace talus::engine {

/// In the order of their bodies. Waits for the step.
std::vector<Pair> read_pairs(Simulation&);

struct ContactRecords {
    std::vector<Manifold> manifolds;           ///< one a pair, with no points where the two do not touch
    std::vector<ManifoldPoint> points;         ///< four a manifold
    std::vector<Separations> separations;      ///< one a manifold
    std::vector<NormalImpulses> next_impulses; ///< one a manifold: what the next step starts from
    std::vector<float> impulses;               ///< N·s along the normal, one a point: of the whole step, hits included
    std::vector<BodyStart> starts;             ///< one a body slot that there is room for
};

/// Waits for the step.
ContactRecords read_contacts(Simulation&);

} // namespace talus::engine
