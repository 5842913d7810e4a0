// SPDX-License-Identifier: MIT
// Where the contacts of this step, those of the last one and the constraints lie in one OpenGL buffer, so that the
// constraints take the memory of contacts that are not wanted any more:
//
//     [ four arrays ][ gap, where the constraints are longer, or PairTable and by turns others ][ four arrays ]
//
// In the gap lie PairTable and by turns the boxes that a search has put in order, as TreeNodes or as SortedAabbs,
// behind as much of the table as the search itself needs, and then, behind all of the table, what steps list, as
// Uncoloured, and what sorts need besides their keys and values. It is as long as these at least: constraints are not
// wanted any more when the broad phase begins to use them, and they are not when constraints are made. Behind the
// constraints lie FastBodies, which are wanted while these are solved. The arrays at the start are the new contacts and
// those at the end the old ones, or the other way round: swap makes the new ones old. The constraints lie over the one
// or the other, and over the gap: in a step over the old contacts from where they are placed on, and over the new ones
// from its end until the next search. A step that has few of them may place them into the gap alone. Where the end of a
// step needs the old contacts, and the table, there is no gap, and the constraints, the table and what is behind it lie
// behind all of these.
//
// This only reckons; see GlDevice for the buffer.
#pragma once

#include <algorithm>

#include "device/device.h"

namespace talus::engine {

/// What lies in it.
inline constexpr auto k_room_buffers = [] {
    std::array<BufferId, 2 * k_contact_buffers.size() + 3 + k_by_turns.size()> all{};
    for (std::size_t i = 0; i < k_contact_buffers.size(); ++i) {
        all[2 * i] = k_contact_buffers[i];
        all[2 * i + 1] = k_old_contact_buffers[i];
    }
    std::size_t next = 2 * k_contact_buffers.size();
    for (const BufferId other : {BufferId::Constraints, BufferId::FastBodies, BufferId::PairTable})
        all[next++] = other;
    for (const BufferId other : k_by_turns)
        all[next++] = other;
    return all;
}();

class ContactRoom {
public:
    /// Bytes of the buffer.
    struct Place {
        std::size_t offset = 0;
        std::size_t bytes = 0;
    };

    /// A block may begin at each of the places, and none is empty.
    explicit ContactRoom(const ContactDemand& demand) { fit(demand); }

    std::size_t bytes() const;
    Place place(BufferId) const;
    /// Whether its content means nothing, as the constraints lie over it, or each step makes it anew.
    bool is_covered(BufferId) const;

    /// Room for at least so many, with the same arrays at the start and the same ones covered; constraints that lay
    /// beside the contacts come to lie over the new ones. Once the old contacts are kept they remain so.
    ContactRoom grown(const ContactDemand&) const;
    /// Whether everything begins where it does in the other one, in a buffer as long.
    bool has_places_of(const ContactRoom&) const;

    void place_constraints(ConstraintPlace where) { constraints_ = where; }
    /// How many lie over no contacts.
    uint constraints_beside() const;
    void swap();

private:
    void fit(const ContactDemand&);
    /// Of all that is wanted before the constraints.
    std::size_t bytes_before() const {
        return std::max(partners_bytes_ + boxes_bytes_, table_bytes_ + list_bytes_ + 2 * swap_bytes_);
    }
    std::size_t gap_bytes() const;
    /// Of the constraints and what lies behind them.
    std::size_t solver_bytes() const { return constraint_bytes_ + fast_bytes_; }
    /// What takes turns over and behind the table, which begins there.
    Place place_by_turns(BufferId, std::size_t table_begin) const;

    ContactDemand demand_;         // the most so far, of each
    std::size_t arrays_bytes_ = 0; // of the new contacts, or of the old ones
    std::size_t constraint_bytes_ = 0;
    std::size_t fast_bytes_ = 0;
    std::size_t table_bytes_ = 0;
    std::size_t partners_bytes_ = 0; // of the table's beginning, which a search uses
    std::size_t boxes_bytes_ = 0;    // of TreeNodes, and of SortedAabbs
    std::size_t list_bytes_ = 0;     // of Uncoloured
    std::size_t swap_bytes_ = 0;     // of SwapKeys, and of SwapValues

    bool starts_with_old_ = true;
    ConstraintPlace constraints_ = ConstraintPlace::OverNewContacts;
};

} // namespace talus::engine
