// SPDX-License-Identifier: MIT
// What the twins of search_strays and compare_strays ask about a stray and another body, and the list of those that are
// near.
#pragma once

#include <atomic>

#include "broad_phase/box_now.h"

namespace talus::engine {

/// The launch of either.
struct StraySearch {
    const CpuState& state;
    Array<uint> marks; ///< StrayMarks

    bool is_stray(uint body) const { return std::atomic_ref(marks[body]).load(std::memory_order_relaxed) != 0; }

    /// By the boxes that both had, of which the list was made: then they are in it.
    bool was_near(uint stray, uint body) const {
        return is_candidate(state.aabbs[stray], state.aabbs[body]) &&
               !faces_part(state.oriented_boxes[stray], state.oriented_boxes[body]);
    }

    /// Of two bodies whose bounding boxes overlap. `box`: the stray's.
    void look_at(uint stray, const OrientedBox& box, uint body) const {
        const bool both = is_stray(body);
        if (body == stray || (both && body < stray)) return;
        const OrientedBox other = both ? box_with_skin(state, body) : state.oriented_boxes[body];
        if (!faces_part(box, other) && !was_near(stray, body)) note_near(stray, body);
    }

private:
    void note_near(uint stray, uint body) const {
        const uint body_count = state.parameters.body_count;
        std::atomic_ref(marks[stray]).store(k_stray_near, std::memory_order_relaxed);
        const uint place = std::atomic_ref(state.counters[k_counter_near_pairs]).fetch_add(1);
        if (place >= most_near_pairs(body_count)) {
            std::atomic_ref(state.counters[k_counter_search_count]).store(body_count);
            return;
        }
        const Pair pair = make_pair(stray, body);
        state.near_pairs[place] = pair;
        const uint last = near_table_size(body_count) - 1;
        uint slot = hash_pair(pair.body_a, pair.body_b) & last;
        for (uint expected = k_none; !std::atomic_ref(state.near_table[slot]).compare_exchange_strong(expected, place);
             expected = k_none)
            slot = (slot + 1) & last;
    }
};

} // namespace talus::engine
