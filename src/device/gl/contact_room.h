// SPDX-License-Identifier: MIT
// Where the contacts of this step, those of the last one and the constraints lie in one OpenGL buffer, so that the
// constraints take the memory of contacts that are not wanted any more:
//
//     [ four arrays ][ gap, where the constraints are longer than these ][ four arrays ]
//
// The arrays at the start are the new contacts and those at the end the old ones, or the other way round: swap makes
// the new ones old. The constraints lie over the one or the other, and over the gap: in a step over the old contacts
// from begin_constraints on, and over the new ones from its end until the next narrow phase. Where the end of a step
// needs the old contacts, there is no gap, and the constraints lie behind all of these.
//
// This only reckons; see GlDevice for the buffer.
#pragma once

#include "device/device.h"

namespace talus::engine {

/// What lies in it.
inline constexpr auto k_room_buffers = [] {
    std::array<BufferId, 2 * k_contact_buffers.size() + 1> all{};
    for (std::size_t i = 0; i < k_contact_buffers.size(); ++i) {
        all[2 * i] = k_contact_buffers[i];
        all[2 * i + 1] = k_old_contact_buffers[i];
    }
    all.back() = BufferId::Constraints;
    return all;
}();

class ContactRoom {
public:
    /// Bytes of the buffer.
    struct Place {
        std::size_t offset = 0;
        std::size_t bytes = 0;
    };

    /// For contacts of so many pairs and the constraints of so many manifolds. A block may begin at each of the places,
    /// and none is empty.
    ContactRoom(uint pairs, uint manifolds, bool keeps_old) { fit(pairs, manifolds, keeps_old); }

    std::size_t bytes() const;
    Place place(BufferId) const;
    /// Whether the constraints lie over it, so that its content means nothing.
    bool is_covered(BufferId) const;

    /// Room for at least so many, with the same arrays at the start and the same ones covered. Once the old contacts
    /// are kept they remain so.
    ContactRoom grown(uint pairs, uint manifolds, bool keeps_old) const;
    /// Whether everything begins where it does in the other one, in a buffer as long.
    bool has_places_of(const ContactRoom&) const;

    void begin_constraints() { over_old_ = true; }
    void swap();

private:
    void fit(uint pairs, uint manifolds, bool keeps_old);
    std::size_t gap_bytes() const;

    uint pairs_ = 0;
    uint manifolds_ = 0;
    bool keeps_old_ = false;
    std::size_t arrays_bytes_ = 0; // of the new contacts, or of the old ones
    std::size_t constraint_bytes_ = 0;

    bool starts_with_old_ = true;
    bool over_old_ = false; // where the constraints lie
};

} // namespace talus::engine
