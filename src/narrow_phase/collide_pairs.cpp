// SPDX-License-Identifier: MIT
// CPU twin of collide_pairs.comp.glsl.
#include <algorithm>
#include <array>
#include <span>

#include "device/cpu/cpu_state.h"
#include "narrow_phase/lane_queries.h"
#include "narrow_phase/narrow_phase.h"
#include "narrow_phase/old_contact.h"
#include "narrow_phase/pairs_to_collide.h"
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

/// A pair whose contact does not last.
struct PairInHand {
    uint index;
    uint old_index; ///< of its last manifold; k_none: it has none
};

void put_manifold(CpuState& state, const PairInHand& in_hand, ContactGeometry& g) {
    const Pair pair = state.pairs[in_hand.index];
    const BodyShape &shape_a = state.shapes[pair.body_a], &shape_b = state.shapes[pair.body_b];
    const bool sensed = is_sensed(shape_a, shape_b);
    if (sensed && !can_meet(shape_a, shape_b)) g = no_contact();
    if (g.count == 0) return put_none(state, in_hand.index, gap_without_points(g));

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

uint take_in_hand(const CpuState& state, PartList list, std::array<PairInHand, k_part>& in_hand) {
    uint count = 0;
    for (uint entry = list.next(); entry != k_none; entry = list.next()) {
        const uint index = entry & ~k_had_contact;
        in_hand[count++] = {index, (entry & k_had_contact) != 0 ? old_manifold_of(state, index) : k_none};
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
    const Array<uint> words = state.words(launch.bound("PairsToCollide"));
    const auto collide_part = [&](uint, uint first, uint end) {
        std::array<PairInHand, k_part> in_hand;
        std::array<ContactGeometry, k_part> found;
        const uint count = take_in_hand(state, PartList(words, first, end), in_hand);
        const auto others = std::partition(in_hand.begin(), in_hand.begin() + count, [&](const PairInHand& each) {
            return are_boxes(state, state.pairs[each.index]);
        });
        const auto box_count = static_cast<uint>(others - in_hand.begin());
        collide_boxes_ahead(state, {in_hand.data(), box_count}, found.data());
        for (uint i = box_count; i < count; ++i)
            found[i] = collide_pair(state, in_hand[i]);
        for (uint i = 0; i < count; ++i) {
            put_manifold(state, in_hand[i], found[i]);
            compare_with_last(state, in_hand[i].index);
        }
    };
    state.parallel_parts(pair_count, k_part, collide_part, 2 * k_part);
}

} // namespace

const Kernel collide_pairs{"narrow_phase/collide_pairs", collide_pairs_on_cpu};

} // namespace talus::engine
