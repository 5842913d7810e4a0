// SPDX-License-Identifier: MIT
// LaneQueries for one set of instructions. Included once by each lane_queries_*.cpp.
#pragma once

#include "device/cpu/lane_formulas.h"
#include "narrow_phase/lane_queries.h"

namespace talus::engine::TALUS_LANES_NAME {

TALUS_LANE BodyPose poses_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto position = gather(state.poses.data, bodies, 0);
    return {three_of(position), floatBitsToUint(position.w), all_of(gather(state.poses.data, bodies, 1))};
}

/// The linear ones are all that is asked for.
TALUS_LANE BodyVelocity velocities_at(const CpuState& state, const std::uint32_t* bodies) {
    BodyVelocity velocity;
    velocity.linear = three_of(gather(state.velocities.data, bodies, 0));
    return velocity;
}

TALUS_LANE BodyShape shapes_at(const CpuState& state, const std::uint32_t* bodies) {
    const auto shape = gather(state.shapes.data, bodies, 0);
    return {three_of(shape), floatBitsToUint(shape.w)};
}

/// Of what lies one behind the other.
#if TALUS_LANES == 4
constexpr std::uint32_t k_places[k_lanes] = {0, 1, 2, 3};
#else
constexpr std::uint32_t k_places[k_lanes] = {0, 1, 2, 3, 4, 5, 6, 7};
#endif

/// Of a Pair or a BoxQuestion in each lane.
struct BodiesOfPairs {
    std::uint32_t a[k_lanes], b[k_lanes];
};

template <typename Item> TALUS_LANE BodiesOfPairs bodies_of(const Item* items) {
    BodiesOfPairs bodies;
    for (int lane = 0; lane < k_lanes; ++lane) {
        bodies.a[lane] = items[lane].body_a;
        bodies.b[lane] = items[lane].body_b;
    }
    return bodies;
}

TALUS_LANE Aabb aabbs_now(const CpuState& state, const std::uint32_t* bodies) {
    return compute_aabb(make_oriented_box(poses_at(state, bodies), velocities_at(state, bodies),
                                          shapes_at(state, bodies), state.parameters));
}

inline NearPairs find_near(const CpuState& state, const engine::Pair* pairs) {
    const BodiesOfPairs bodies = bodies_of(pairs);
    const Aabb a = aabbs_now(state, bodies.a), b = aabbs_now(state, bodies.b);
    return {bits_of(is_candidate(a, b)), bits_of(is_still_candidate(a, b))};
}

typedef float Word __attribute__((may_alias));

/// Writes a record of each lane, whose members follow each other as they do in the lanes' own.
template <typename RecordOfLanes, typename Record> TALUS_LANE void put(const RecordOfLanes& lanes, Record* records) {
    constexpr std::size_t k_words = sizeof(Record) / 4;
    static_assert(sizeof(RecordOfLanes) == k_words * sizeof(Lanes));
    const auto* const words = reinterpret_cast<const Lanes*>(&lanes);
    constexpr std::size_t k_cells = k_words / 4;
    for (std::size_t cell = 0; cell < k_cells; ++cell)
        scatter(records, k_places, cell, k_lane_mask,
                {words[4 * cell], words[4 * cell + 1], words[4 * cell + 2], words[4 * cell + 3]});
    for (std::size_t word = 4 * k_cells; word < k_words; ++word)
        for (int lane = 0; lane < k_lanes; ++lane)
            reinterpret_cast<Word*>(&records[lane])[word] = words[word].v[lane];
}

inline void collide_boxes(const CpuState& state, const BoxQuestion* questions, engine::ContactGeometry* answers) {
    const BodiesOfPairs bodies = bodies_of(questions);
    const FourLanes first = gather(questions, k_places, 0), second = gather(questions, k_places, 1);
    const Carriers carriers{
        floatBitsToUint(first.z),
        {floatBitsToUint(first.w), floatBitsToUint(second.x), floatBitsToUint(second.y), floatBitsToUint(second.z)}};
    const ULanes had_contact = floatBitsToUint(gather(questions, k_places, 2).x);
    const vec3 motion =
        motion_between(velocities_at(state, bodies.a), velocities_at(state, bodies.b), state.parameters);
    BodyPose pose_b = poses_at(state, bodies.b);
    pose_b.position = add_scaled(pose_b.position, motion, second.w);
    const BoxPair boxes =
        make_box_pair(poses_at(state, bodies.a), shapes_at(state, bodies.a), pose_b, shapes_at(state, bodies.b));
    put(collide_boxes(boxes, carriers, contact_reach(motion, had_contact != 0u, state.parameters)), answers);
}

} // namespace talus::engine::TALUS_LANES_NAME
