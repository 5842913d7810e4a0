// SPDX-License-Identifier: MIT
// CPU twin of renew_contacts.comp.glsl.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/lane_queries.h"
#include "narrow_phase/narrow_phase.h"
#include "narrow_phase/old_contact.h"
#include "narrow_phase/pairs_to_collide.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

bool sleeps(const CpuState& state, const Pair& pair) {
    const auto [a, b] = pair;
    return sleep_on(state.poses[a], state.velocities[a], state.shapes[a], state.poses[b], state.velocities[b],
                    state.shapes[b]);
}

/// How far apart the bodies of a pair were at least that did not touch; 0: it is not known.
float old_gap(const CpuState& state, uint pair_index) {
    if (state.counters[k_counter_pairs_changed] != 0 || !was_listed(state, pair_index)) return 0.0f;
    const Manifold& old = state.old_manifolds[pair_index];
    return old.point_count == 0 ? old.weights : 0.0f;
}

void keep_manifold(CpuState& state, uint pair_index, uint old_index) {
    if (old_index == k_none) { // they were apart
        put_none(state, pair_index, old_gap(state, pair_index));
        return;
    }
    state.manifolds[pair_index] = state.old_manifolds[old_index];
    state.point_separations[pair_index] = state.old_point_separations[old_index];
    state.point_impulses[pair_index] = state.old_point_impulses[old_index];
    std::copy_n(&state.old_manifold_points[std::size_t{4} * old_index], state.old_manifolds[old_index].point_count,
                &state.manifold_points[std::size_t{4} * pair_index]);
}

float gap_now(const CpuState& state, uint pair_index) {
    const float gap = old_gap(state, pair_index);
    if (!(gap > 0.0f)) return 0.0f;
    const auto [body_a, body_b] = state.pairs[pair_index];
    const BodyStart &start_a = state.starts[body_a], &start_b = state.starts[body_b];
    const BodyShape &shape_a = state.shapes[body_a], &shape_b = state.shapes[body_b];
    if (!may_last(start_a, shape_a, start_b, shape_b)) return 0.0f;
    const Movement a = last_movement(state.poses[body_a], start_a), b = last_movement(state.poses[body_b], start_b);
    const vec3 offset = offset_at_meeting(start_a.position, start_b.position, vec3(0.0f));
    return gap_after(gap, way_between(a, b, centre_of_smaller(offset, shape_a, shape_b)));
}

/// Whether a pair without a contact to renew is to be listed; else it is written that it has none.
bool list_or_put_none(CpuState& state, uint pair_index, bool is_near) {
    const auto [a, b] = state.pairs[pair_index];
    const vec3 motion = motion_between(state.velocities[a], state.velocities[b], state.parameters);
    const float gap = gap_now(state, pair_index);
    if (is_near && !is_surely_apart(gap, motion, state.parameters)) return true;
    put_none(state, pair_index, gap);
    compare_with_last(state, pair_index);
    return false;
}

void renew_contacts_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> words = state.words(launch.bound("PairsToCollide"));
    const uint pair_count = state.counters[k_counter_pair_count];
    const bool is_old_list =
        launch.args[0] == 1 && state.counters[k_counter_pairs_changed] == 0 && state.counters[k_counter_same_list] != 0;
    const float most = most_way(launch.args[1] == 1, state.parameters);
    const bool may_sleep = state.parameters.rest_steps > 0;
    std::atomic<uint> count = 0;
    const auto renew_part = [&](uint, uint first, uint end) {
        // Those whose contacts are not there, and have not been copied.
        std::uint64_t awake = ~std::uint64_t{0} >> (k_pairs_a_part - (end - first));
        for (uint index = first; may_sleep && index < end; ++index) {
            const Pair& pair = state.pairs[index];
            const bool is_there = is_old_list && are_settled(state.poses[pair.body_a], state.poses[pair.body_b]);
            if (!is_there && !sleeps(state, pair)) continue;
            awake &= ~(std::uint64_t{1} << (index - first));
            if (!is_there) keep_manifold(state, index, old_manifold_of(state, index));
        }
        std::uint64_t listed = 0, had_contact = 0;
        std::array<LastContact, k_pairs_a_part> contacts;
        uint contact_count = 0;
        const NearPairs near = awake != 0 ? find_near(state, &state.pairs[first], end - first)
                                          : NearPairs{}; // the search saw boxes with a skin
        for (std::uint64_t left = awake; left != 0; left &= left - 1) {
            const std::uint64_t bit = left & (0 - left);
            const uint index = first + static_cast<uint>(std::countr_zero(left));
            const uint old_index = (near.still & bit) != 0 ? old_manifold_of(state, index) : k_none;
            if (old_index != k_none) {
                contacts[contact_count++] = {index, old_index};
                had_contact |= bit;
            } else if (list_or_put_none(state, index, (near.now & bit) != 0)) {
                listed |= bit;
            }
        }
        const std::uint64_t lasting = renew_last_contacts(state, contacts.data(), contact_count, most);
        for (uint i = 0; i < contact_count; ++i) {
            if ((lasting >> i & 1u) == 0) listed |= std::uint64_t{1} << (contacts[i].pair - first);
        }
        PartList list(words, first, end);
        for (; listed != 0; listed &= listed - 1) {
            const auto place = static_cast<uint>(std::countr_zero(listed));
            list.add((first + place) | ((had_contact >> place & 1u) != 0 ? k_had_contact : 0u));
        }
        count.fetch_add(list.close(), std::memory_order_relaxed);
    };
    state.parallel_parts(pair_count, k_pairs_a_part, renew_part, 2 * k_pairs_a_part);
    state.counters[k_counter_pairs_to_collide] = count;
}

} // namespace

const Kernel renew_contacts{"narrow_phase/renew_contacts", renew_contacts_on_cpu};

} // namespace talus::engine
