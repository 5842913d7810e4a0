// SPDX-License-Identifier: MIT
// The searches for machines with AVX2; src/CMakeLists.txt gives this file its compiler options.
#define TALUS_LANES 8
#define TALUS_LANES_NAME lanes_avx2
#include "broad_phase/lane_search_body.h"

namespace talus::engine {

extern const LaneSearch lane_search_avx2;
const LaneSearch lane_search_avx2{TALUS_LANES,
                                  sizeof(lanes_avx2::Aabb),
                                  lanes_avx2::take_boxes,
                                  lanes_avx2::find_partners,
                                  lanes_avx2::find_parted,
                                  lanes_avx2::search_tree};

} // namespace talus::engine
