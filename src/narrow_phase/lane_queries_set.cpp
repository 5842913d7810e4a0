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

} // namespace talus::engine::TALUS_LANES_NAME

namespace talus::engine {

extern const LaneQueries TALUS_OF_SET(lane_queries);
const LaneQueries TALUS_OF_SET(lane_queries){TALUS_LANES, TALUS_LANES_NAME::find_near,
                                             TALUS_LANES_NAME::collide_box_pairs};

} // namespace talus::engine
