// SPDX-License-Identifier: MIT
// CPU twin of update_aabbs.comp.glsl.
#include "broad_phase/box_now.h"
#include "broad_phase/broad_phase.h"
#include "broad_phase/lane_search.h"

namespace talus::engine {

static void update_aabbs_of_strays(CpuState& state, bool with_tree) {
    const Array<uint>& counters = state.counters;
    if (counters[k_counter_did_not_fit] != 0) return;
    const uint count = found_strays(counters[k_counter_stray_count], counters[k_counter_search_count], with_tree);
    state.parallel(count, [&](uint i) {
        const uint body = state.strays[i];
        const OrientedBox box = box_with_skin(state, body);
        state.oriented_boxes[body] = box;
        state.aabbs[body] = compute_aabb(box);
    });
}

static void update_aabbs_on_cpu(CpuState& state, const Launch& launch) {
    if (launch.args[0] == 1) return update_aabbs_of_strays(state, launch.args[1] == 1);
    const LaneSearch& search = lane_search();
    state.parallel_parts(state.counters[k_counter_search_count], search.lanes,
                         [&](uint, uint first, uint end) { search.update_boxes(state, first, end - first); });
}

const Kernel update_aabbs{"broad_phase/update_aabbs", update_aabbs_on_cpu};

} // namespace talus::engine
