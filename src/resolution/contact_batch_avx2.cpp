// SPDX-License-Identifier: MIT
// Contact batches for machines with AVX2. CMakeLists.txt gives this file its compiler options.
#define TALUS_LANES 8
#define TALUS_LANES_NAME lanes_avx2
#include "resolution/contact_batch_lanes.h"

namespace talus::engine {

extern const ContactBatch contact_batch_avx2;
const ContactBatch contact_batch_avx2{TALUS_LANES, lanes_avx2::pass_over_batch};

} // namespace talus::engine
