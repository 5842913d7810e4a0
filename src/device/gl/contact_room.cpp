// SPDX-License-Identifier: MIT
// See contact_room.h.
#include "device/gl/contact_room.h"

#include <algorithm>

#include "device/gl/record_blocks.h"
#include "log.h"

namespace talus::engine {
namespace {

// The most that GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT may be.
constexpr std::size_t k_alignment = 256;

constexpr std::size_t aligned(std::size_t bytes) {
    return (bytes + k_alignment - 1) / k_alignment * k_alignment;
}

static_assert(element_bytes(BufferId::Constraints) % k_alignment == 0);

bool is_one_of(const auto& buffers, BufferId id) {
    return std::ranges::find(buffers, id) != buffers.end();
}

} // namespace

void ContactRoom::fit(uint pairs, uint manifolds, bool keeps_old) {
    pairs_ = std::max({pairs, pairs_, 1u});
    manifolds_ = std::max({manifolds, manifolds_, 1u});
    keeps_old_ = keeps_old || keeps_old_;
    arrays_bytes_ = 0;
    for (const BufferId buffer : k_contact_buffers)
        arrays_bytes_ += aligned(pairs_ * bytes_a_pair(buffer));
    const std::size_t blocks = (manifolds_ + k_block_records - 1) / k_block_records;
    constraint_bytes_ = blocks * element_bytes(BufferId::Constraints);
}

std::size_t ContactRoom::gap_bytes() const {
    return keeps_old_ ? 0 : std::max(constraint_bytes_, arrays_bytes_) - arrays_bytes_;
}

std::size_t ContactRoom::bytes() const {
    return 2 * arrays_bytes_ + (keeps_old_ ? constraint_bytes_ : gap_bytes());
}

ContactRoom::Place ContactRoom::place(BufferId id) const {
    if (id == BufferId::Constraints) {
        const bool over_start = over_old_ == starts_with_old_;
        return {keeps_old_ ? 2 * arrays_bytes_ : over_start ? 0 : arrays_bytes_, constraint_bytes_};
    }
    const bool is_old = is_one_of(k_old_contact_buffers, id);
    Place place{is_old == starts_with_old_ ? 0 : arrays_bytes_ + gap_bytes(), 0};
    for (const BufferId buffer : is_old ? k_old_contact_buffers : k_contact_buffers) {
        place.bytes = pairs_ * bytes_a_pair(buffer);
        if (buffer == id) return place;
        place.offset += aligned(place.bytes);
    }
    TALUS_ASSERT(false, "a buffer was looked for among the contacts that is not one of them");
    return {};
}

bool ContactRoom::is_covered(BufferId id) const {
    return !keeps_old_ && is_one_of(over_old_ ? k_old_contact_buffers : k_contact_buffers, id);
}

ContactRoom ContactRoom::grown(uint pairs, uint manifolds, bool keeps_old) const {
    ContactRoom larger = *this;
    larger.fit(pairs, manifolds, keeps_old);
    return larger;
}

bool ContactRoom::has_places_of(const ContactRoom& other) const {
    return pairs_ == other.pairs_ && keeps_old_ == other.keeps_old_ && starts_with_old_ == other.starts_with_old_ &&
           over_old_ == other.over_old_ && bytes() == other.bytes();
}

void ContactRoom::swap() {
    starts_with_old_ = !starts_with_old_;
    over_old_ = false;
}

} // namespace talus::engine
