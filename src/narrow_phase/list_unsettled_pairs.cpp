// SPDX-License-Identifier: MIT
// CPU twin of list_unsettled_pairs.comp.glsl. Its list has a bit for each pair, which collide_pairs reads in its order.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/narrow_phase.h"
#include "narrow_phase/pairs_in_bits.h"
#include "state/formulas.h"

namespace talus::engine {

static void list_unsettled_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> words = state.words(launch.bound("UnsettledPairs"));
    const uint pair_count = state.counters[k_counter_pair_count];
    const bool is_old_list = state.counters[k_counter_pairs_changed] == 0 && state.counters[k_counter_same_list] != 0;
    std::atomic<uint> count = 0;
    state.parallel_parts(pair_count, k_pairs_a_part, [&](uint, uint first, uint end) {
        std::uint64_t listed = 0;
        for (uint i = first; i < end; ++i) {
            const Pair& pair = state.pairs[i];
            const bool has_contact = is_old_list && are_settled(state.poses[pair.body_a], state.poses[pair.body_b]);
            if (!has_contact) listed |= std::uint64_t{1} << (i - first);
        }
        put_bits(words, first, listed);
        count.fetch_add(static_cast<uint>(std::popcount(listed)), std::memory_order_relaxed);
    });
    state.counters[k_counter_unsettled_pairs] = count;
    state.dispatches[k_dispatch_unsettled_pairs] = groups_for(count, k_group_size);
}

const Kernel list_unsettled_pairs{"narrow_phase/list_unsettled_pairs", list_unsettled_pairs_on_cpu};

} // namespace talus::engine
