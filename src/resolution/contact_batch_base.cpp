// SPDX-License-Identifier: MIT
// Contact batches with the instructions that every machine of the kind has.
#define TALUS_LANES 4
#define TALUS_LANES_NAME lanes_base
#include "resolution/contact_batch_lanes.h"

namespace talus::engine {

extern const ContactBatch contact_batch_base;
const ContactBatch contact_batch_base{TALUS_LANES, lanes_base::pass_over_batch};

} // namespace talus::engine
