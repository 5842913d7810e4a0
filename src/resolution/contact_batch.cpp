// SPDX-License-Identifier: MIT
#include "resolution/contact_batch.h"

#include <algorithm>

namespace talus::engine {

// One a file, as each is compiled for its own instructions.
extern const ContactBatch contact_batch_base;
#ifdef TALUS_HAS_AVX2
extern const ContactBatch contact_batch_avx2;
#endif

const ContactBatch& contact_batch() {
#ifdef TALUS_HAS_AVX2
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    if (has_avx2) return contact_batch_avx2;
#endif
    return contact_batch_base;
}

void pass_over_colour(CpuState& state, ContactPass pass, uint substep, const uint* indices, uint count) {
    const ContactBatch& batch = contact_batch();
    for (uint first = 0; first < count; first += batch.lanes) {
        const uint* const part = indices + first;
        uint left_alone = batch.pass(state, pass, substep, part, std::min(batch.lanes, count - first));
        for (; left_alone != 0; left_alone &= left_alone - 1)
            pass_over_constraint(state, pass, substep, part[findLSB(left_alone)]);
    }
}

} // namespace talus::engine
