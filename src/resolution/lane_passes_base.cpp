// SPDX-License-Identifier: MIT
// The passes with the instructions that every machine of its kind has.
#define TALUS_LANES 4
#define TALUS_LANES_NAME lanes_base
#include "resolution/lane_passes_body.h"

namespace talus::engine {

extern const LanePasses lane_passes_base;
const LanePasses lane_passes_base{TALUS_LANES,
                                  lanes_base::prepare_contacts,
                                  sizeof(lanes_base::ConstraintBatch),
                                  lanes_base::take_constraints,
                                  lanes_base::pass_over_batch,
                                  sizeof(lanes_base::BodyBatch),
                                  lanes_base::take_bodies,
                                  lanes_base::integrate_batch};

} // namespace talus::engine
