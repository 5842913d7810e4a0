// SPDX-License-Identifier: MIT
// The sweep for machines with AVX2; src/CMakeLists.txt gives this file its compiler options.
#define TALUS_LANES 8
#define TALUS_LANES_NAME lanes_avx2
#include "broad_phase/lane_sweep_body.h"

namespace talus::engine {

extern const LaneSweep lane_sweep_avx2;
const LaneSweep lane_sweep_avx2{TALUS_LANES, sizeof(lanes_avx2::Aabb), lanes_avx2::take_boxes,
                                lanes_avx2::find_partners};

} // namespace talus::engine
