// SPDX-License-Identifier: MIT
// CPU twin of update_aabbs.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"

namespace talus::engine {

static void update_aabbs_on_cpu(CpuState& state, const Launch&) {
    for_bodies_in_lanes(state, state.counters[k_counter_search_count],
                        [&](uint first, uint count) { lane_search().update_boxes(state, first, count); });
}

const Kernel update_aabbs{"broad_phase/update_aabbs", update_aabbs_on_cpu};

} // namespace talus::engine
