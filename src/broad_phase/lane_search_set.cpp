// SPDX-License-Identifier: MIT
// LaneSearch for one set of instructions: src/CMakeLists.txt compiles this once for each.
#include "broad_phase/lane_search.h"
#include "device/cpu/instruction_set.h"
#include "device/cpu/lane_records.h"

namespace talus::engine::TALUS_LANES_NAME {

static_assert(sizeof(Aabb) % 64 == 0, "lines of SearchMemory");

// The way through the tree is one for all lanes. Once more here, as functions that are not inlined may only be compiled
// for every machine.
TALUS_LANE int findLSB(std::uint32_t value) {
    return __builtin_ctz(value);
}
#pragma GCC diagnostic push
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Wkeyword-macro"
#endif
#define inline [[gnu::always_inline]] inline
#include "broad_phase/tree.shared.glsl"
#undef inline
#pragma GCC diagnostic pop

/// From `first` on; where there are fewer bodies than lanes, the last one again.
struct BodiesInTurn {
    std::uint32_t of_lane[k_lanes];
};
TALUS_LANE BodiesInTurn bodies_from(std::uint32_t first, std::uint32_t count) {
    BodiesInTurn bodies;
    for (std::uint32_t lane = 0; lane < k_lanes; ++lane)
        bodies.of_lane[lane] = first + (lane < count ? lane : count - 1);
    return bodies;
}

inline void update_boxes(const CpuState& state, std::uint32_t first, std::uint32_t count) {
    const BodiesInTurn bodies = bodies_from(first, count);
    const std::uint32_t lanes = (1u << count) - 1u;
    const OrientedBox box = with_skin(boxes_now(state, bodies.of_lane), state.parameters);
    const Aabb aabb = compute_aabb(box);
    engine::OrientedBox* const boxes = state.oriented_boxes.data;
    scatter(boxes, bodies.of_lane, 0, lanes, {box.centre.x, box.centre.y, box.centre.z, box.margin});
    scatter(boxes, bodies.of_lane, 1, lanes, {box.rotation.x, box.rotation.y, box.rotation.z, box.rotation.w});
    scatter(boxes, bodies.of_lane, 2, lanes,
            {box.half_extents.x, box.half_extents.y, box.half_extents.z, uintBitsToFloat(box.type)});
    scatter(state.aabbs.data, bodies.of_lane, 0, lanes, {aabb.lower.x, aabb.lower.y, aabb.lower.z, aabb.margin});
    scatter(state.aabbs.data, bodies.of_lane, 1, lanes,
            {aabb.upper.x, aabb.upper.y, aabb.upper.z, uintBitsToFloat(aabb.movable)});
}

inline std::uint32_t find_strays(const CpuState& state, std::uint32_t first, std::uint32_t count) {
    const BodiesInTurn bodies = bodies_from(first, count);
    const OrientedBox searched = oriented_boxes_at(state.oriented_boxes.data, bodies.of_lane);
    return ~bits_of(is_within(boxes_now(state, bodies.of_lane), searched)) & ((1u << count) - 1u);
}

inline void take_boxes(const engine::Aabb* boxes, std::uint32_t count, void* memory) {
    std::uint32_t places[k_lanes];
    for (std::uint32_t lane = 0; lane < k_lanes; ++lane)
        places[lane] = lane < count ? lane : 0;
    const auto lower = gather(boxes, places, 0), upper = gather(boxes, places, 1);
    *static_cast<Aabb*>(memory) = {three_of(lower), lower.w, three_of(upper), floatBitsToUint(upper.w)};
}

inline std::uint32_t find_partners(const engine::Aabb& box, const void* memory, std::uint32_t first, std::uint32_t end,
                                   std::uint32_t* partners) {
    const Aabb* const batches = static_cast<const Aabb*>(memory);
    const Aabb own{box.lower, box.margin, box.upper, box.movable};
    std::uint32_t count = 0;
    for (std::uint32_t batch = first / k_lanes; batch * k_lanes < end; ++batch) {
        const std::uint32_t place = batch * k_lanes;
        std::uint32_t found = bits_of(is_candidate(own, batches[batch]));
        if (place < first) found &= k_lane_mask << (first - place);
        if (end - place < k_lanes) found &= (1u << (end - place)) - 1u;
        for (; found != 0; found &= found - 1)
            partners[count++] = place + static_cast<std::uint32_t>(__builtin_ctz(found));
    }
    return count;
}

inline std::uint32_t find_parted(const PlacesView& view, const std::uint32_t* places, const std::uint32_t* partners) {
    std::uint32_t a[k_lanes], b[k_lanes];
    for (int lane = 0; lane < k_lanes; ++lane) {
        a[lane] = view.bodies[places[lane]];
        b[lane] = view.bodies[partners[lane]];
    }
    return bits_of(faces_part(oriented_boxes_at(view.boxes, a), oriented_boxes_at(view.boxes, b)));
}

/// From a place on, at which it begins with the node that has that shift; no higher than `highest`. Of the first
/// `in_order` lanes each only looks at what comes behind its own place, which is `first` for the first of them.
TALUS_LANE void walk_tree(const TreeView& tree, const Aabb& own, std::uint32_t all, std::uint32_t place,
                          std::uint32_t shift, std::uint32_t highest, std::uint32_t first, std::uint32_t in_order,
                          const auto& meet) {
    while (place < tree.end) {
        std::uint32_t found = 0;
        for (;; shift -= k_tree_bits) {
            const engine::Aabb& node = tree.nodes[tree_node(place, shift, tree.top)];
            found = bits_of(is_candidate(own, Aabb{node.lower, node.margin, node.upper, node.movable})) & all;
            // Lanes that begin behind all of the node's places.
            const std::uint32_t before = place + (1u << shift) - 1u - first;
            if (before < in_order) found &= (1u << before) - 1u;
            if (found == 0 || shift == 0) break;
        }
        if (found != 0) meet(place, found);
        place += 1u << shift;
        const std::uint32_t next = tree_shift_from(place);
        shift = next < highest ? next : highest;
    }
}

inline void search_tree(const TreeView& tree, std::uint32_t first, std::uint32_t count, TakePartner take,
                        void* context) {
    std::uint32_t leaves[k_lanes], bodies[k_lanes];
    for (std::uint32_t lane = 0; lane < k_lanes; ++lane) {
        const std::uint32_t place = first + (lane < count ? lane : 0);
        leaves[lane] = tree_node(place, 0, tree.top);
        bodies[lane] = tree.bodies[place];
    }
    const auto lower = gather(tree.nodes, leaves, 0), upper = gather(tree.nodes, leaves, 1);
    const Aabb own{three_of(lower), lower.w, three_of(upper), floatBitsToUint(upper.w)};
    const OrientedBox own_oriented = oriented_boxes_at(tree.boxes, bodies);
    walk_tree(tree, own, (1u << count) - 1u, first + 1, 0, tree.top, first, count,
              [&](std::uint32_t place, std::uint32_t found) {
                  const engine::OrientedBox& other = tree.boxes[tree.bodies[place]];
                  const vec4 rotation{other.rotation.x, other.rotation.y, other.rotation.z, other.rotation.w};
                  const OrientedBox oriented{other.centre, other.margin, rotation, other.half_extents, other.type};
                  found &= ~bits_of(faces_part(own_oriented, oriented));
                  if (found != 0) take(context, place, found);
              });
}

inline void search_tree_for(const TreeView& tree, std::uint32_t shift, const engine::Aabb* boxes, std::uint32_t count,
                            TakePartner take, void* context) {
    Aabb own;
    take_boxes(boxes, count, &own);
    walk_tree(tree, own, (1u << count) - 1u, 0, shift, shift, 0, 0,
              [&](std::uint32_t place, std::uint32_t found) { take(context, place, found); });
}

} // namespace talus::engine::TALUS_LANES_NAME

namespace talus::engine {

extern const LaneSearch TALUS_OF_SET(lane_search);
const LaneSearch TALUS_OF_SET(lane_search){TALUS_LANES,
                                           TALUS_LANES_NAME::update_boxes,
                                           TALUS_LANES_NAME::find_strays,
                                           sizeof(TALUS_LANES_NAME::Aabb),
                                           TALUS_LANES_NAME::take_boxes,
                                           TALUS_LANES_NAME::find_partners,
                                           TALUS_LANES_NAME::find_parted,
                                           TALUS_LANES_NAME::search_tree,
                                           TALUS_LANES_NAME::search_tree_for};

} // namespace talus::engine
