// SPDX-License-Identifier: MIT
// The sweep with the instructions that every machine of its kind has.
#define TALUS_LANES 4
#define TALUS_LANES_NAME lanes_base
#include "broad_phase/lane_sweep_body.h"

namespace talus::engine {

extern const LaneSweep lane_sweep_base;
const LaneSweep lane_sweep_base{TALUS_LANES, sizeof(lanes_base::Aabb), lanes_base::take_boxes,
                                lanes_base::find_partners};

} // namespace talus::engine
