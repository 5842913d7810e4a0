// SPDX-License-Identifier: MIT
// The queries for machines with AVX2; src/CMakeLists.txt gives this file its compiler options.
#define TALUS_LANES 8
#define TALUS_LANES_NAME lanes_avx2
#include "narrow_phase/lane_queries_body.h"

namespace talus::engine {

extern const LaneQueries lane_queries_avx2;
const LaneQueries lane_queries_avx2{TALUS_LANES, lanes_avx2::find_near, lanes_avx2::collide_boxes};

} // namespace talus::engine
