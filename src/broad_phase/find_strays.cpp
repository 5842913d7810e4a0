// SPDX-License-Identifier: MIT
// CPU twin of find_strays.comp.glsl.
#include <atomic>

#include "broad_phase/box_now.h"
#include "broad_phase/broad_phase.h"

namespace talus::engine {

static void find_strays_on_cpu(CpuState& state, const Launch&) {
    if (state.counters[k_counter_did_not_fit] != 0) return;
    const uint body_count = state.parameters.body_count;
    std::atomic<bool> strays = state.counters[k_counter_searched_slots] != body_count;
    if (!strays) {
        state.parallel(body_count, [&](uint body) {
            if (strays.load(std::memory_order_relaxed)) return;
            if (!is_within(box_now(state, body), state.oriented_boxes[body]))
                strays.store(true, std::memory_order_relaxed);
        });
    }
    if (strays) state.counters[k_counter_search_count] = body_count;
}

const Kernel find_strays{"broad_phase/find_strays", find_strays_on_cpu};

} // namespace talus::engine
