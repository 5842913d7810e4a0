// SPDX-License-Identifier: MIT
// CPU twin of sweep_in_group.comp.glsl.
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"
#include "state/buffers.h"

namespace talus::engine {

static_assert(k_island_bodies == 1024, "the kernel's invocations, one a body slot");

static void sweep_in_group_on_cpu(CpuState& state, const Launch&) {
    if (state.counters[k_counter_search_count] == 0) return;
    constexpr uint count = 0, write = 1;
    sweep_pairs.twin(state, {.kernel = sweep_pairs, .args = {count}});
    scan_group.twin(state, {.kernel = scan_group,
                            .args = {k_counter_search_count, k_counter_found_pairs, 1, 1},
                            .bindings = {{"Values", BufferId::PairCounts}}});
    sweep_pairs.twin(state, {.kernel = sweep_pairs, .args = {write}});
}

const Kernel sweep_in_group{"broad_phase/sweep_in_group", sweep_in_group_on_cpu, 1};

} // namespace talus::engine
