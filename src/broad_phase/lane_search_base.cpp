// SPDX-License-Identifier: MIT
// The searches with the instructions that every machine of its kind has.
#define TALUS_LANES 4
#define TALUS_LANES_NAME lanes_base
#include "broad_phase/lane_search_body.h"

namespace talus::engine {

extern const LaneSearch lane_search_base;
const LaneSearch lane_search_base{TALUS_LANES,
                                  sizeof(lanes_base::Aabb),
                                  lanes_base::take_boxes,
                                  lanes_base::find_partners,
                                  lanes_base::find_parted,
                                  lanes_base::search_tree};

} // namespace talus::engine
