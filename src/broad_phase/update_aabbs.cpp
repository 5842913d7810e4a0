// SPDX-License-Identifier: MIT
// CPU twin of update_aabbs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"

namespace talus::engine {

static void update_aabbs_on_cpu(CpuState& state, const Launch&) {
    const LaneSearch& search = lane_search();
    state.parallel_parts(state.counters[k_counter_search_count], search.lanes,
                         [&](uint, uint first, uint end) { search.update_boxes(state, first, end - first); });
}

const Kernel update_aabbs{"broad_phase/update_aabbs", update_aabbs_on_cpu};

} // namespace talus::engine
