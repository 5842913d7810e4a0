// SPDX-License-Identifier: MIT
// CPU twin of update_aabbs.comp.glsl.
#include "broad_phase/box_now.h"
#include "broad_phase/broad_phase.h"

namespace talus::engine {

static void update_aabbs_on_cpu(CpuState& state, const Launch&) {
    state.parallel(state.counters[k_counter_search_count], [&](uint body) {
        const OrientedBox box = box_with_skin(state, body);
        state.oriented_boxes[body] = box;
        state.aabbs[body] = compute_aabb(box);
    });
}

const Kernel update_aabbs{"broad_phase/update_aabbs", update_aabbs_on_cpu};

} // namespace talus::engine
