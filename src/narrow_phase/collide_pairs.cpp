// SPDX-License-Identifier: MIT
// CPU twin of collide_pairs.comp.glsl.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <span>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/lane_queries.h"
#include "narrow_phase/narrow_phase.h"
#include "narrow_phase/pair_table.h"
#include "narrow_phase/pairs_in_bits.h"
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
    const auto stays = [&](uint body) {
        return is_left_alone(state.poses[body], state.velocities[body], state.shapes[body]);
    };
    return (is_asleep(state.poses[pair.body_a]) || is_asleep(state.poses[pair.body_b])) && stays(pair.body_a) &&
           stays(pair.body_b);
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
};

void put_manifold(CpuState& state, const PairInHand& in_hand, ContactGeometry& g) {
    const Pair pair = state.pairs[in_hand.index];
    const BodyShape &shape_a = state.shapes[pair.body_a], &shape_b = state.shapes[pair.body_b];
    const bool sensed = is_sensed(shape_a, shape_b);
    if (sensed && !can_meet(shape_a, shape_b)) g.count = 0;
    if (g.count == 0) return put_none(state, in_hand.index);

    Manifold manifold = make_manifold(pair, g, state.properties[pair.body_a], state.properties[pair.body_b]);
    vec4 impulses(0.0f);
    if (in_hand.old_index != k_none) {
        manifold = carry_over(manifold, state.old_manifolds[in_hand.old_index], state.parameters);
        impulses = carry_impulses(g, read_old_points(state, in_hand.old_index));
    } else if (is_placed(state.poses[pair.body_a], shape_a) && is_placed(state.poses[pair.body_b], shape_b)) {
        manifold = begin_trial(manifold, state.parameters);
    }
    if (sensed) {
        manifold = make_sensed(manifold);
        impulses = vec4(0.0f);
    }
    state.manifolds[in_hand.index] = manifold;
    state.point_impulses[in_hand.index] = {impulses};
    state.point_separations[in_hand.index] = make_separations(g);
    for (uint i = 0; i < g.count; ++i)
        state.manifold_points[std::size_t{4} * in_hand.index + i] = make_point(g.points[i], g.features[i]);
}

bool are_boxes(const CpuState& state, const Pair& pair) {
    const auto is_box = [&](uint body) { return (state.shapes[body].type & 255u) == k_shape_box; };
    return is_box(pair.body_a) && is_box(pair.body_b);
}

constexpr uint k_part = k_pairs_a_part;

/// Of those of a part that are listed, a bit each, those that do not sleep; the others' manifolds are written.
std::uint64_t find_awake(CpuState& state, uint first, std::uint64_t listed, bool same_pairs) {
    if (state.parameters.rest_steps == 0) return listed;
    std::uint64_t awake = listed;
    for (; listed != 0; listed &= listed - 1) {
        const uint index = first + static_cast<uint>(std::countr_zero(listed));
        if (!sleeps(state, state.pairs[index])) continue;
        awake &= ~(listed & (0 - listed));
        keep_manifold(state, index, old_manifold_of(state, index, same_pairs));
    }
    return awake;
}

/// Of the awake pairs of a part those that have to be collided; the others' manifolds are written.
uint take_in_hand(CpuState& state, uint first, uint end, std::uint64_t awake, bool same_pairs,
                  std::array<PairInHand, k_part>& in_hand) {
    uint count = 0;
    const NearPairs near = find_near(state, &state.pairs[first], end - first); // the search saw boxes with a skin
    for (uint index = first; index < end; ++index) {
        const auto is_among = [&](std::uint64_t pairs) { return (pairs >> (index - first) & 1u) != 0; };
        if (!is_among(awake)) continue;
        const uint old_index = is_among(near.still) ? old_manifold_of(state, index, same_pairs) : k_none;
        if (old_index == k_none && !is_among(near.now))
            put_none(state, index);
        else
            in_hand[count++] = {index, old_index};
    }
    return count;
}

vec3 motion_of(const CpuState& state, const Pair& pair) {
    return motion_between(state.velocities[pair.body_a], state.velocities[pair.body_b], state.parameters);
}

Carriers carriers_of_last(const CpuState& state, const PairInHand& in_hand) {
    return in_hand.old_index == k_none ? no_carriers() : carriers_of(read_old_points(state, in_hand.old_index));
}

ContactGeometry collide_pair(const CpuState& state, const PairInHand& in_hand) {
    const auto [a, b] = state.pairs[in_hand.index];
    const vec3 motion = motion_of(state, {a, b});
    return collide_moving_shapes(state.poses[a], state.shapes[a], state.poses[b], state.shapes[b], motion,
                                 carriers_of_last(state, in_hand),
                                 contact_reach(motion, in_hand.old_index != k_none, state.parameters));
}

/// The same for pairs of boxes, side by side.
void collide_boxes_ahead(const CpuState& state, std::span<const PairInHand> pairs, ContactGeometry* found) {
    std::array<BoxQuestion, k_part> questions; // of those that are still to be looked at
    std::array<uint, k_part> of_pair;
    std::array<LookAhead, k_part> aheads;
    uint count = 0;
    for (const PairInHand& pair : pairs) {
        const auto [a, b] = state.pairs[pair.index];
        questions[count] = {a, b, carriers_of_last(state, pair), 0.0f, pair.old_index != k_none ? 1u : 0u};
        aheads[count] = begin_look_ahead();
        of_pair[count] = count;
        ++count;
    }
    std::array<ContactGeometry, k_part> memory;
    for (ContactGeometry* met = found; count > 0; met = memory.data()) { // the first look is where they are
        collide_box_pairs(state, questions.data(), count, met);
        uint left = 0;
        for (uint i = 0; i < count; ++i) {
            const vec3 motion = motion_of(state, {questions[i].body_a, questions[i].body_b});
            const LookAhead ahead = look_on(aheads[i], met[i], motion);
            ContactGeometry& now = found[of_pair[i]];
            if (!ahead.ends) {
                questions[left] = questions[i];
                questions[left].time = ahead.next;
                aheads[left] = ahead;
                of_pair[left++] = of_pair[i];
            } else if (met != found) {
                now = contact_ahead(now, met[i], ahead.time, motion);
            }
        }
        count = left;
    }
}

void collide_pairs_on_cpu(CpuState& state, const Launch& launch) {
    const uint pair_count = state.counters[k_counter_pair_count];
    const bool same_pairs = state.counters[k_counter_pairs_changed] == 0;
    const bool some = launch.args[0] == 1;
    const Array<uint> words = state.words(launch.bound("UnsettledPairs"));
    const auto collide_part = [&](uint, uint first, uint end) {
        const std::uint64_t all = ~std::uint64_t{0} >> (k_part - (end - first));
        const std::uint64_t awake = find_awake(state, first, some ? bits_at(words, first) : all, same_pairs);
        if (awake == 0) return;
        std::array<PairInHand, k_part> in_hand;
        std::array<ContactGeometry, k_part> found;
        const uint count = take_in_hand(state, first, end, awake, same_pairs, in_hand);
        const auto others = std::partition(in_hand.begin(), in_hand.begin() + count, [&](const PairInHand& each) {
            return are_boxes(state, state.pairs[each.index]);
        });
        const auto box_count = static_cast<uint>(others - in_hand.begin());
        collide_boxes_ahead(state, {in_hand.data(), box_count}, found.data());
        for (uint i = box_count; i < count; ++i)
            found[i] = collide_pair(state, in_hand[i]);
        for (uint i = 0; i < count; ++i)
            put_manifold(state, in_hand[i], found[i]);
        for (uint index = first; same_pairs && index < end; ++index)
            if ((awake >> (index - first) & 1u) != 0) compare_with_last(state, index);
    };
    state.parallel_parts(pair_count, k_part, collide_part, 2 * k_part);
}

} // namespace

const Kernel collide_pairs{"narrow_phase/collide_pairs", collide_pairs_on_cpu};

} // namespace talus::engine
