// SPDX-License-Identifier: MIT
// Boxes side by side, one in each lane of the CPU's vector registers: made of bodies, against the ones that the last
// search had of them, several against one and in pairs, as a sweep asks, or through the tree together.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// The tree of the broad phase, and what its leaves stand for.
struct TreeView {
    const Aabb* nodes;
    const OrientedBox* boxes; ///< of the bodies
    const uint* bodies;       ///< at the places
    uint top;                 ///< the shift of the root
    uint end;                 ///< of the places that hold a body
};

/// What the places of a sweep stand for.
struct PlacesView {
    const OrientedBox* boxes; ///< of the bodies
    const uint* bodies;       ///< at the places
};

/// Called for a partner at a place, with a bit for each lane that it is one of.
using TakePartner = void (*)(void* context, uint place, uint lanes);

struct LaneSearch {
    uint lanes; ///< boxes side by side
    /// The boxes that a search has of at most as many bodies as there are lanes, from `first` on.
    void (*update_boxes)(const CpuState&, uint first, uint count);
    /// Of such bodies, a bit for each that is not within the box that the last search had of it.
    uint (*find_strays)(const CpuState&, uint first, uint count);
    std::size_t batch_bytes; ///< of as many boxes in the form of lanes
    /// Makes a batch of at most as many boxes as there are lanes.
    void (*take_boxes)(const Aabb* boxes, uint count, void* batch);
    /// Writes which of the boxes `first` to `end` - 1 are candidates to `partners`, in order, and returns how many.
    uint (*find_partners)(const Aabb&, const void* batches, uint first, uint end, uint* partners);
    /// Of as many pairs of places as there are lanes, a bit for each whose boxes a face parts.
    uint (*find_parted)(const PlacesView&, const uint* places, const uint* partners);
    /// Goes through the tree with the `count` bodies from the place `first` on, one in each lane, and takes for each
    /// those at later places that are candidates and that no face parts from it, in the order of their places.
    void (*search_tree)(const TreeView&, uint first, uint count, TakePartner take, void* context);
    /// Goes through it, from its nodes of a shift down, with at most as many boxes as there are lanes, and takes for
    /// each the places of all boxes that are candidates.
    void (*search_tree_for)(const TreeView&, uint shift, const Aabb* boxes, uint count, TakePartner take,
                            void* context);
};

/// With the widest registers that this machine has.
const LaneSearch& lane_search();

/// What the launches of a search keep: boxes in the form of lanes, and the partners that were found when they were
/// counted.
class SearchMemory {
public:
    static constexpr uint k_part = 32; ///< places whose partners lie together

    /// The device's.
    static SearchMemory& of(CpuState&);

    /// Before a search, for as many places.
    void begin(uint count) { partners_.resize((count + k_part - 1) / k_part); }
    /// Those that others are compared with from now on.
    void take_boxes(const CpuState&, std::span<const Aabb>);
    /// Appends which of the boxes from `first` to `end` - 1 are candidates.
    void find_partners(const Aabb&, uint first, uint end, std::vector<uint>& partners) const;
    /// Leaves of pairs of a place and a partner those that no face parts, in order.
    void keep_unparted(const PlacesView&, std::vector<uint>& places, std::vector<uint>& partners) const;
    /// Appends the partners in the tree of the bodies from `first` to `end` - 1, one body after the other, and writes
    /// how many each has.
    void search_tree(const TreeView&, uint first, uint end, std::vector<uint>& partners, uint* counts) const;
    /// Of the places from `part` k_part on, one place after the other.
    std::vector<uint>& partners_of(uint part) { return partners_[part]; }
    /// All of them, once PairCounts has become where those of each place begin.
    void write_pairs(CpuState&, uint count) const;
    std::size_t memory_bytes() const;

private:
    struct alignas(64) Line {
        std::byte bytes[64];
    };

    std::vector<Line> boxes_;
    std::vector<std::vector<uint>> partners_;
};

} // namespace talus::engine
