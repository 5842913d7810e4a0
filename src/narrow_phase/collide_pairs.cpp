// SPDX-License-Identifier: MIT
// CPU twin of collide_pairs.comp.glsl.
#include <algorithm>
#include <array>
#include <atomic>
#include <span>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/lane_queries.h"
#include "narrow_phase/narrow_phase.h"
#include "narrow_phase/pair_table.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

/// None where the pair had no manifold.
OldPoints read_old_points(const CpuState& state, uint old_index) {
    OldPoints old{};
    old.axis = k_axis_none;
    if (old_index == k_none) return old;
    const Manifold& manifold = state.old_manifolds[old_index];
    const ManifoldPoint* const points = &state.old_manifold_points[std::size_t{4} * old_index];
    old.axis = manifold.axis;
    old.count = manifold.point_count;
    for (uint i = 0; i < old.count; ++i) {
        old.anchors[i] = points[i].anchor;
        old.features[i] = points[i].feature_id;
        old.impulses[i] = state.old_point_impulses[old_index].normal[static_cast<int>(i)];
    }
    return old;
}

bool sleeps(const CpuState& state, const Pair& pair) {
    const auto is_left_alone = [&](uint body) {
        return engine::is_left_alone(state.poses[body], state.velocities[body], state.shapes[body]);
    };
    return (is_asleep(state.poses[pair.body_a]) || is_asleep(state.poses[pair.body_b])) && is_left_alone(pair.body_a) &&
           is_left_alone(pair.body_b);
}

void put_none(CpuState& state, uint pair_index) {
    state.manifolds[pair_index] = no_manifold(state.pairs[pair_index]);
    state.point_impulses[pair_index] = {vec4(0.0f)};
}

void keep_manifold(CpuState& state, uint pair_index, uint old_index) {
    if (old_index == k_none) { // they were apart
        put_none(state, pair_index);
        return;
    }
    state.manifolds[pair_index] = state.old_manifolds[old_index];
    state.point_separations[pair_index] = state.old_point_separations[old_index];
    state.point_impulses[pair_index] = state.old_point_impulses[old_index];
    std::copy_n(&state.old_manifold_points[std::size_t{4} * old_index], state.old_manifolds[old_index].point_count,
                &state.manifold_points[std::size_t{4} * pair_index]);
}

/// Pairs that have been added come behind those of the last step.
bool was_listed(const CpuState& state, uint pair_index) {
    return pair_index < state.counters[k_counter_old_pair_count];
}

uint old_manifold_of(const CpuState& state, uint pair_index, bool same_pairs) {
    const Pair& pair = state.pairs[pair_index];
    if (!same_pairs) return find_old_manifold(state, pair.body_a, pair.body_b);
    return was_listed(state, pair_index) && state.old_manifolds[pair_index].point_count > 0 ? pair_index : k_none;
}

void compare_with_last(CpuState& state, uint pair_index) {
    const Manifold &old = state.old_manifolds[pair_index], &manifold = state.manifolds[pair_index];
    if ((was_listed(state, pair_index) && is_active(old)) != is_active(manifold))
        std::atomic_ref(state.counters[k_counter_graph_due]).store(1, std::memory_order_relaxed);
    else if (is_active(manifold) && manifold.point_count != old.point_count)
        std::atomic_ref(state.counters[k_counter_contact_count])
            .fetch_add(manifold.point_count - old.point_count, std::memory_order_relaxed);
}

/// A pair that is near, and not asleep.
struct PairInHand {
    uint index;
    uint old_index; ///< of its last manifold; k_none: it has none
    OldPoints old;
    AxisQuery axes; ///< no_query() where one is no box
};

void collide_pair(CpuState& state, const PairInHand& in_hand) {
    const Pair pair = state.pairs[in_hand.index];
    const BodyPose& pose_a = state.poses[pair.body_a];
    const BodyPose& pose_b = state.poses[pair.body_b];
    const vec3 motion =
        (state.velocities[pair.body_b].linear - state.velocities[pair.body_a].linear) * state.parameters.dt;
    const float max_separation = contact_reach(motion, in_hand.old_index != k_none, state.parameters);
    ContactGeometry g = collide_moving_shapes(pose_a, state.shapes[pair.body_a], pose_b, state.shapes[pair.body_b],
                                              motion, carriers_of(in_hand.old), in_hand.axes, max_separation);
    const bool sensed = is_sensed(state.shapes[pair.body_a], state.shapes[pair.body_b]);
    if (sensed && !can_meet(state.shapes[pair.body_a], state.shapes[pair.body_b])) g.count = 0;

    Manifold manifold = make_manifold(pair, g, state.properties[pair.body_a], state.properties[pair.body_b]);
    vec4 impulses(0.0f);
    if (in_hand.old_index != k_none) {
        manifold = carry_over(manifold, state.old_manifolds[in_hand.old_index], state.parameters);
        impulses = carry_impulses(g, in_hand.old);
    } else if (is_placed(pose_a, state.shapes[pair.body_a]) && is_placed(pose_b, state.shapes[pair.body_b])) {
        manifold = begin_trial(manifold, state.parameters);
    }
    if (sensed) {
        manifold = make_sensed(manifold);
        impulses = vec4(0.0f);
    }
    state.manifolds[in_hand.index] = manifold;
    state.point_impulses[in_hand.index] = {impulses};
    if (g.count == 0) return;
    state.point_separations[in_hand.index] = make_separations(g);
    for (uint i = 0; i < g.count; ++i)
        state.manifold_points[std::size_t{4} * in_hand.index + i] = make_point(g.points[i], g.features[i]);
}

constexpr uint k_part = 32; // pairs that a thread treats together, and bits of a word

/// The pairs of a part that have to be collided; the others' manifolds are written.
uint take_in_hand(CpuState& state, uint first, uint end, bool same_pairs, std::array<PairInHand, k_part>& in_hand) {
    uint count = 0;
    const NearPairs near = find_near(state, &state.pairs[first], end - first); // the search saw boxes with a skin
    for (uint index = first; index < end; ++index) {
        const Pair pair = state.pairs[index];
        const auto is_among = [&](uint pairs) { return (pairs >> (index - first) & 1u) != 0; };
        if (state.parameters.rest_steps > 0 && sleeps(state, pair)) {
            keep_manifold(state, index, old_manifold_of(state, index, same_pairs));
            continue;
        }
        const uint old_index = is_among(near.still) ? old_manifold_of(state, index, same_pairs) : k_none;
        if (old_index == k_none && !is_among(near.now))
            put_none(state, index);
        else
            in_hand[count++] = {index, old_index, read_old_points(state, old_index), no_query()};
    }
    return count;
}

/// Of the pairs of boxes, side by side.
void query_axes_of(const CpuState& state, std::span<PairInHand> in_hand) {
    std::array<AxisQuestion, k_part> questions{};
    std::array<AxisQuery, k_part> answers;
    const auto is_box = [&](uint body) { return (state.shapes[body].type & 255u) == k_shape_box; };
    const auto is_asked = [&](const Pair& pair) { return is_box(pair.body_a) && is_box(pair.body_b); };
    uint count = 0;
    for (const PairInHand& each : in_hand) {
        const Pair& pair = state.pairs[each.index];
        if (is_asked(pair)) questions[count++] = {pair.body_a, pair.body_b, each.old.axis};
    }
    query_axes(state, questions.data(), count, answers.data());
    count = 0;
    for (PairInHand& each : in_hand) {
        if (is_asked(state.pairs[each.index])) each.axes = answers[count++];
    }
}

void collide_pairs_on_cpu(CpuState& state, const Launch&) {
    const uint pair_count = state.counters[k_counter_pair_count];
    const bool same_pairs = state.counters[k_counter_pairs_changed] == 0;
    const auto collide_part = [&](uint part) {
        const uint first = part * k_part, end = std::min(first + k_part, pair_count);
        std::array<PairInHand, k_part> memory;
        const std::span in_hand(memory.data(), take_in_hand(state, first, end, same_pairs, memory));
        query_axes_of(state, in_hand);
        for (const PairInHand& each : in_hand)
            collide_pair(state, each);
        for (uint index = first; same_pairs && index < end; ++index)
            compare_with_last(state, index);
    };
    state.parallel((pair_count + k_part - 1) / k_part, collide_part, 2);
}

} // namespace

const Kernel collide_pairs{"narrow_phase/collide_pairs", collide_pairs_on_cpu};

} // namespace talus::engine
