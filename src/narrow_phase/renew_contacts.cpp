// SPDX-License-Identifier: MIT
// CPU twin of renew_contacts.comp.glsl. Its list has a bit for each pair, which collide_pairs reads in its order.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/lane_queries.h"
#include "narrow_phase/narrow_phase.h"
#include "narrow_phase/old_contact.h"
#include "narrow_phase/pairs_in_bits.h"
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

/// How two bodies have moved in the last step.
struct PairMovement {
    Movement a;
    Movement b;
    vec3 offset;   ///< m, from A's centre to B's before
    bool may_last; ///< what was known of them
};

PairMovement movement_of(const CpuState& state, const Pair& pair) {
    const BodyStart &start_a = state.starts[pair.body_a], &start_b = state.starts[pair.body_b];
    return {last_movement(state.poses[pair.body_a], start_a), last_movement(state.poses[pair.body_b], start_b),
            offset_at_meeting(start_a.position, start_b.position, vec3(0.0f)),
            may_last(start_a, state.shapes[pair.body_a], start_b, state.shapes[pair.body_b])};
}

/// Whether the contact lasts; then it is this step's.
bool renew(CpuState& state, uint pair_index, uint old_index) {
    const Parameters& p = state.parameters;
    const auto [body_a, body_b] = state.pairs[pair_index];
    const BodyVelocity &velocity_a = state.velocities[body_a], &velocity_b = state.velocities[body_b];
    const Manifold& old = state.old_manifolds[old_index];
    const Separations& old_separations = state.old_point_separations[old_index];
    const auto [a, b, offset, may] = movement_of(state, state.pairs[pair_index]);
    if (!may || !is_of_kind_that_lasts(old, old_separations)) return false;
    const ManifoldPoint* const old_points = &state.old_manifold_points[std::size_t{4} * old_index];
    const MeetingPoint meeting =
        meeting_point(old_points[0].anchor, offset, state.shapes[body_a], state.shapes[body_b]);
    const float way = way_after(old_separations, way_between(a, b, meeting));
    if (!stays(way, next_movement(velocity_a, p), next_movement(velocity_b, p), meeting, p)) return false;
    const Manifold manifold = lasting_manifold(old, a, b, p);
    vec4 opening(0.0f);
    for (uint i = 0; i < old.point_count; ++i)
        opening[static_cast<int>(i)] = opening_at(manifold.normal, old_points[i].anchor, offset, a, b);
    const Separations separations = lasting_separations(old_separations, opening, way, old.point_count);
    if (!is_within_reach(separations, old.point_count, motion_between(velocity_a, velocity_b, p), p)) return false;

    state.manifolds[pair_index] = manifold;
    state.point_impulses[pair_index] = state.old_point_impulses[old_index];
    state.point_separations[pair_index] = separations;
    for (uint i = 0; i < old.point_count; ++i)
        state.manifold_points[std::size_t{4} * pair_index + i] =
            make_point(lasting_anchor(old_points[i].anchor, offset, a, b), old_points[i].feature_id);
    return true;
}

float gap_now(const CpuState& state, uint pair_index) {
    const Pair& pair = state.pairs[pair_index];
    const auto [a, b, offset, may] = movement_of(state, pair);
    if (!may) return 0.0f;
    const MeetingPoint centre = centre_of_smaller(offset, state.shapes[pair.body_a], state.shapes[pair.body_b]);
    return gap_after(old_gap(state, pair_index), way_between(a, b, centre));
}

/// Whether the pair is to be listed; the contact of others is there, or is written here.
bool is_to_collide(CpuState& state, uint pair_index, bool is_near, bool is_still_near) {
    const uint old_index = is_still_near ? old_manifold_of(state, pair_index) : k_none;
    if (old_index != k_none) return !renew(state, pair_index, old_index);
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
        std::uint64_t listed = 0;
        const NearPairs near = awake != 0 ? find_near(state, &state.pairs[first], end - first)
                                          : NearPairs{}; // the search saw boxes with a skin
        for (std::uint64_t left = awake; left != 0; left &= left - 1) {
            const std::uint64_t bit = left & (0 - left);
            const uint index = first + static_cast<uint>(std::countr_zero(left));
            if (is_to_collide(state, index, (near.now & bit) != 0, (near.still & bit) != 0)) listed |= bit;
        }
        put_bits(words, first, listed);
        count.fetch_add(static_cast<uint>(std::popcount(listed)), std::memory_order_relaxed);
    };
    state.parallel_parts(pair_count, k_pairs_a_part, renew_part, 2 * k_pairs_a_part);
    state.counters[k_counter_pairs_to_collide] = count;
}

} // namespace

const Kernel renew_contacts{"narrow_phase/renew_contacts", renew_contacts_on_cpu};

} // namespace talus::engine
