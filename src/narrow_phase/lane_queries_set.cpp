// SPDX-License-Identifier: MIT
// LaneQueries for one set of instructions: src/CMakeLists.txt compiles this once for each.
#include "device/cpu/instruction_set.h"
#include "device/cpu/lane_records.h"
#include "narrow_phase/lane_queries.h"

namespace talus::engine::TALUS_LANES_NAME {

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

inline NearPairs find_near(const CpuState& state, const engine::Pair* pairs) {
    const BodiesOfPairs bodies = bodies_of(pairs);
    const Aabb a = compute_aabb(boxes_now(state, bodies.a)), b = compute_aabb(boxes_now(state, bodies.b));
    return {bits_of(is_candidate(a, b)), bits_of(is_still_candidate(a, b))};
}

/// Cell by cell, as contact_geometry.shared.glsl has them.
TALUS_LANE void put_geometries(const ContactGeometry& g, engine::ContactGeometry* to) {
    const auto put = [&](std::size_t cell, Lanes x, Lanes y, Lanes z, Lanes w) __attribute__((always_inline)) {
        scatter(to, k_places, cell, k_lane_mask, {x, y, z, w});
    };
    const vec3* const p = g.points;
    const Lanes* const s = g.separations;
    const auto feature = [&](int i) __attribute__((always_inline)) {
        return uintBitsToFloat(g.features[i]);
    };
    put(0, g.normal.x, g.normal.y, g.normal.z, uintBitsToFloat(g.axis));
    put(1, g.shift.x, g.shift.y, g.shift.z, g.separation);
    put(2, uintBitsToFloat(g.count), p[0].x, p[0].y, p[0].z);
    put(3, p[1].x, p[1].y, p[1].z, p[2].x);
    put(4, p[2].y, p[2].z, p[3].x, p[3].y);
    put(5, p[3].z, s[0], s[1], s[2]);
    put(6, s[3], feature(0), feature(1), feature(2));
    for (int lane = 0; lane < k_lanes; ++lane)
        to[lane].features[3] = g.features[3].v[lane];
}

static_assert(sizeof(engine::ContactGeometry) == 7 * sizeof(Cell) + 4 &&
              offsetof(engine::ContactGeometry, points) == 2 * sizeof(Cell) + 4 &&
              offsetof(engine::ContactGeometry, features) == 6 * sizeof(Cell) + 4);

inline void collide_box_pairs(const CpuState& state, const BoxQuestion* questions, engine::ContactGeometry* answers) {
    const BodiesOfPairs bodies = bodies_of(questions);
    const FourLanes first = gather(questions, k_places, 0), second = gather(questions, k_places, 1);
    const Carriers carriers{
        floatBitsToUint(first.z),
        {floatBitsToUint(first.w), floatBitsToUint(second.x), floatBitsToUint(second.y), floatBitsToUint(second.z)}};
    static_assert(offsetof(BoxQuestion, carriers) == 8 && offsetof(BoxQuestion, time) == 2 * sizeof(Cell) - 4 &&
                  offsetof(BoxQuestion, had_contact) == 2 * sizeof(Cell));
    const ULanes had_contact = floatBitsToUint(gather(questions, k_places, 2).x);
    const vec3 motion =
        motion_between(velocities_at(state, bodies.a), velocities_at(state, bodies.b), state.parameters);
    BodyPose pose_b = poses_at(state, bodies.b);
    pose_b.position = add_scaled(pose_b.position, motion, second.w);
    const BoxPair boxes =
        make_box_pair(poses_at(state, bodies.a), shapes_at(state, bodies.a), pose_b, shapes_at(state, bodies.b));
    put_geometries(collide_boxes(boxes, carriers, contact_reach(motion, had_contact != 0u, state.parameters)), answers);
}

inline std::uint32_t renew_last_contacts(const CpuState& state, const LastContact* contacts, std::uint32_t lanes,
                                         float most) {
    std::uint32_t pairs[k_lanes], places[k_lanes];
    BodiesOfPairs bodies;
    for (int lane = 0; lane < k_lanes; ++lane) {
        pairs[lane] = contacts[lane].pair;
        places[lane] = contacts[lane].manifold;
        bodies.a[lane] = state.pairs[pairs[lane]].body_a;
        bodies.b[lane] = state.pairs[pairs[lane]].body_b;
    }
    const engine::Parameters& p = state.parameters;
    const BodyStart start_a = starts_at(state, bodies.a), start_b = starts_at(state, bodies.b);
    const BodyShape shape_a = shapes_at(state, bodies.a), shape_b = shapes_at(state, bodies.b);
    const BodyVelocity velocity_a = velocities_at(state, bodies.a), velocity_b = velocities_at(state, bodies.b);
    const Separations old_separations = separations_at(state.old_point_separations.data, places);
    const auto old_point = [&](std::uint32_t i) __attribute__((always_inline)) {
        std::uint32_t points[k_lanes];
        for (int lane = 0; lane < k_lanes; ++lane)
            points[lane] = 4 * places[lane] + i;
        return points_at(state.old_manifold_points.data, points);
    };
    const ManifoldPoint point_0 = old_point(0);

    const vec3 offset = offset_at_meeting(start_a.position, start_b.position, vec3(0.0f));
    const MeetingPoint meeting = meeting_point(point_0.anchor, offset, shape_a, shape_b);
    const Movement ahead_a = next_movement(velocity_a, p), ahead_b = next_movement(velocity_b, p);
    const Mask may = mask_of(lanes) && may_last(start_a, shape_a, start_b, shape_b);
    // Where all are about to move too far nothing else has to be asked: the way so far only grows.
    if (!any_lane(may && stays(old_separations.way, ahead_a, ahead_b, meeting, 1.0f, most))) return 0;

    const Manifold old = manifolds_at(state.old_manifolds.data, places);
    const BodyPose pose_a = poses_at(state, bodies.a), pose_b = poses_at(state, bodies.b);
    const Movement a = last_movement(pose_a, start_a), b = last_movement(pose_b, start_b);
    const LastingAxis axis = lasting_axis(old, a, b, pose_a, pose_b);
    const Lanes way = way_after(old_separations, way_between(a, b, meeting), axis.leverage);
    const Manifold manifold = lasting_manifold(old, axis.normal, p);
    const ManifoldPoint point_1 = old_point(1), point_2 = old_point(2), point_3 = old_point(3);
    const auto opening = [&](const ManifoldPoint& point) __attribute__((always_inline)) {
        return opening_at(manifold.normal, point.anchor, offset, a, b);
    };
    const vec4 openings(opening(point_0), opening(point_1), opening(point_2), opening(point_3));
    const Separations separations = lasting_separations(old_separations, openings, way, old.point_count);
    const vec3 motion = motion_between(velocity_a, velocity_b, p);
    const std::uint32_t lasting = bits_of(may && was_found_in_place(old_separations) &&
                                          stays(way, ahead_a, ahead_b, meeting, axis.leverage, most) &&
                                          is_within_reach(separations, old.point_count, motion, p));
    if (lasting == 0) return 0;

    put_manifolds(state, pairs, lasting, manifold);
    put_separations(state, pairs, lasting, separations);
    scatter(state.point_impulses.data, pairs, 0, lasting, gather(state.old_point_impulses.data, places, 0));
    const auto put_point = [&](std::uint32_t i, const ManifoldPoint& point) __attribute__((always_inline)) {
        std::uint32_t points[k_lanes];
        for (int lane = 0; lane < k_lanes; ++lane)
            points[lane] = 4 * pairs[lane] + i;
        const vec3 anchor = lasting_anchor(point.anchor, offset, a, b);
        scatter(state.manifold_points.data, points, 0, lasting & bits_of(i < old.point_count),
                {anchor.x, anchor.y, anchor.z, uintBitsToFloat(point.feature_id)});
    };
    put_point(0, point_0);
    put_point(1, point_1);
    put_point(2, point_2);
    put_point(3, point_3);
    return lasting;
}

} // namespace talus::engine::TALUS_LANES_NAME

namespace talus::engine {

extern const LaneQueries TALUS_OF_SET(lane_queries);
const LaneQueries TALUS_OF_SET(lane_queries){TALUS_LANES, TALUS_LANES_NAME::find_near,
                                             TALUS_LANES_NAME::collide_box_pairs,
                                             TALUS_LANES_NAME::renew_last_contacts};

} // namespace talus::engine
