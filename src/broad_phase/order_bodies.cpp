// SPDX-License-Identifier: MIT
// CPU twin of order_bodies.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"
#include "state/buffers.h"

namespace talus::engine {

static_assert(k_island_bodies <= k_sort_in_group_keys);

static void order_bodies_on_cpu(CpuState& state, const Launch& launch) {
    if (state.counters[k_counter_search_count] == 0) return;
    for (const Kernel* kernel : {&update_aabbs, &measure_spread, &choose_axis, &write_sort_keys})
        kernel->twin(state, launch);
    sort_in_group.twin(state, {.kernel = sort_in_group,
                               .args = {k_counter_search_count},
                               .bindings = {{"Keys", BufferId::SortKeys}, {"Values", BufferId::SortValues}}});
    gather_aabbs.twin(state, launch);
}

const Kernel order_bodies{"broad_phase/order_bodies", order_bodies_on_cpu, 1};

} // namespace talus::engine
