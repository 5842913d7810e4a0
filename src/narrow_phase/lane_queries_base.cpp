// SPDX-License-Identifier: MIT
// The queries with the instructions that every machine of its kind has.
#define TALUS_LANES 4
#define TALUS_LANES_NAME lanes_base
#include "narrow_phase/lane_queries_body.h"

namespace talus::engine {

extern const LaneQueries lane_queries_base;
const LaneQueries lane_queries_base{TALUS_LANES, lanes_base::find_near, lanes_base::collide_boxes};

} // namespace talus::engine
