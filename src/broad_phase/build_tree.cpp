// SPDX-License-Identifier: MIT
// CPU twin of build_tree.comp.glsl.
#include <algorithm>

#include "broad_phase/box_now.h"
#include "broad_phase/broad_phase.h"
#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

static_assert(k_tree_group == 1u << k_tree_shift && k_tree_shift % k_tree_bits == 0);

static void make_leaves(CpuState& state, const Launch& launch, bool for_strays) {
    const uint top = launch.args[1];
    const Array<uint> marks = state.words(launch.bound("StrayMarks"));
    state.parallel(state.parameters.body_count, [&](uint place) {
        if (!for_strays) {
            const uint key = state.sort_keys[place];
            const uint key_before = place > 0 ? state.sort_keys[place - 1] : 0;
            if (is_first_from(k_absent_key, key, key_before)) state.tree_grids[0].end = place;
        }
        const uint body = state.sort_values[place];
        const bool is_stray = for_strays && marks[body] != 0;
        const Aabb box = is_stray ? compute_aabb(box_with_skin(state, body)) : state.aabbs[body];
        state.tree_nodes[tree_node(place, 0, top)] = has_room(box) ? box : empty_box();
    });
}

static void build_tree_on_cpu(CpuState& state, const Launch& launch) {
    const uint search_count = state.counters[k_counter_search_count];
    const bool for_strays = launch.args[2] == 1;
    if ((for_strays ? strays_in_tree(state.counters[k_counter_stray_count], search_count) : search_count) == 0) return;
    const uint lowest = launch.args[0], top = launch.args[1];
    if (lowest == 0) make_leaves(state, launch, for_strays);
    for (uint shift = lowest + k_tree_bits; shift <= std::min(lowest + k_tree_shift, top); shift += k_tree_bits) {
        const uint child_shift = shift - k_tree_bits;
        const uint child_count = tree_level_size(state.parameters.body_count, child_shift);
        state.parallel(tree_level_size(state.parameters.body_count, shift), [&](uint node) {
            const uint first = node << k_tree_bits, last = std::min(first + (1u << k_tree_bits), child_count);
            Aabb box = empty_box();
            for (uint child = first; child < last; ++child)
                box = unite_boxes(box, state.tree_nodes[tree_node(child << child_shift, child_shift, top)]);
            state.tree_nodes[tree_node(node << shift, shift, top)] = box;
        });
    }
}

const Kernel build_tree{"broad_phase/build_tree", build_tree_on_cpu, k_tree_group};

} // namespace talus::engine
