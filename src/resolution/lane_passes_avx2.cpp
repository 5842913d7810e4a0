// SPDX-License-Identifier: MIT
// The passes for machines with AVX2; src/CMakeLists.txt gives this file its compiler options.
#define TALUS_LANES 8
#define TALUS_LANES_NAME lanes_avx2
#include "resolution/lane_passes_body.h"

namespace talus::engine {

extern const LanePasses lane_passes_avx2;
const LanePasses lane_passes_avx2{TALUS_LANES,
                                  lanes_avx2::prepare_contacts,
                                  sizeof(lanes_avx2::ConstraintBatch),
                                  lanes_avx2::take_constraints,
                                  lanes_avx2::pass_over_batch,
                                  sizeof(lanes_avx2::BodyBatch),
                                  lanes_avx2::take_bodies,
                                  lanes_avx2::integrate_batch};

} // namespace talus::engine
