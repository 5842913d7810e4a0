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

// Of constraints, see record_blocks.h.
constexpr std::size_t k_block_bytes = element_bytes(BufferId::Constraints);
static_assert(k_block_bytes % k_alignment == 0);

static_assert(element_bytes(BufferId::TreeNodes) == element_bytes(BufferId::SortedAabbs));

bool is_one_of(const auto& buffers, BufferId id) {
    return std::ranges::find(buffers, id) != buffers.end();
}

} // namespace

void ContactRoom::fit(const ContactDemand& demand) {
    demand_.pairs = std::max({demand.pairs, demand_.pairs, 1u});
    demand_.manifolds = std::max({demand.manifolds, demand_.manifolds, 1u});
    demand_.table_size = std::max({demand.table_size, demand_.table_size, 1u});
    demand_.boxes = std::max({demand.boxes, demand_.boxes, 1u});
    demand_.sorted = std::max({demand.sorted, demand_.sorted, 1u});
    demand_.fast_words = std::max({demand.fast_words, demand_.fast_words, 1u});
    demand_.partners = std::max(demand.partners, demand_.partners);
    TALUS_ASSERT(demand_.partners <= demand_.table_size, "partners have room in the table");
    demand_.keeps_old = demand.keeps_old || demand_.keeps_old;
    arrays_bytes_ = 0;
    for (const BufferId buffer : k_contact_buffers)
        arrays_bytes_ += aligned(demand_.pairs * bytes_a_pair(buffer));
    const std::size_t blocks = (demand_.manifolds + k_block_records - 1) / k_block_records;
    constraint_bytes_ = blocks * k_block_bytes;
    fast_bytes_ = aligned(demand_.fast_words * element_bytes(BufferId::FastBodies));
    table_bytes_ = aligned(demand_.table_size * element_bytes(BufferId::PairTable));
    list_bytes_ = aligned(demand_.pairs * element_bytes(BufferId::Uncoloured));
    swap_bytes_ = aligned(demand_.sorted * element_bytes(BufferId::SwapKeys));
    partners_bytes_ = aligned(demand_.partners * element_bytes(BufferId::PairTable));
    boxes_bytes_ = aligned(demand_.boxes * element_bytes(BufferId::TreeNodes));
}

std::size_t ContactRoom::gap_bytes() const {
    if (demand_.keeps_old) return 0;
    return std::max(std::max(solver_bytes(), arrays_bytes_) - arrays_bytes_, bytes_before());
}

std::size_t ContactRoom::bytes() const {
    return 2 * arrays_bytes_ + (demand_.keeps_old ? solver_bytes() + bytes_before() : gap_bytes());
}

ContactRoom::Place ContactRoom::place(BufferId id) const {
    const std::size_t behind = 2 * arrays_bytes_;
    if (id == BufferId::Constraints) {
        if (demand_.keeps_old) return {behind, constraint_bytes_};
        if (constraints_ == ConstraintPlace::BesideContacts)
            return {arrays_bytes_, constraints_beside() / k_block_records * k_block_bytes};
        const bool over_start = (constraints_ == ConstraintPlace::OverOldContacts) == starts_with_old_;
        return {over_start ? 0 : arrays_bytes_, constraint_bytes_};
    }
    if (id == BufferId::FastBodies) {
        const Place constraints = place(BufferId::Constraints);
        return {constraints.offset + constraints.bytes, fast_bytes_};
    }
    const std::size_t table_begin = demand_.keeps_old ? behind + solver_bytes() : arrays_bytes_;
    if (id == BufferId::PairTable) return {table_begin, table_bytes_};
    if (is_one_of(k_by_turns, id)) return place_by_turns(id, table_begin);
    const bool is_old = is_one_of(k_old_contact_buffers, id);
    Place place{is_old == starts_with_old_ ? 0 : arrays_bytes_ + gap_bytes(), 0};
    for (const BufferId buffer : is_old ? k_old_contact_buffers : k_contact_buffers) {
        place.bytes = demand_.pairs * bytes_a_pair(buffer);
        if (buffer == id) return place;
        place.offset += aligned(place.bytes);
    }
    TALUS_ASSERT(false, "a buffer was looked for among the contacts that is not one of them");
    return {};
}

ContactRoom::Place ContactRoom::place_by_turns(BufferId id, std::size_t table_begin) const {
    const std::size_t begin = table_begin + table_bytes_;
    if (id == BufferId::Uncoloured) return {begin, list_bytes_};
    if (id == BufferId::SwapKeys) return {begin + list_bytes_, swap_bytes_};
    if (id == BufferId::SwapValues) return {begin + list_bytes_ + swap_bytes_, swap_bytes_};
    return {table_begin + partners_bytes_, boxes_bytes_};
}

bool ContactRoom::is_covered(BufferId id) const {
    if (id == BufferId::FastBodies || id == BufferId::PairTable || is_one_of(k_by_turns, id)) return true;
    if (demand_.keeps_old || constraints_ == ConstraintPlace::BesideContacts) return false;
    const bool over_old = constraints_ == ConstraintPlace::OverOldContacts;
    return is_one_of(over_old ? k_old_contact_buffers : k_contact_buffers, id);
}

uint ContactRoom::constraints_beside() const {
    if (demand_.keeps_old) return demand_.manifolds;
    const std::size_t bytes = std::max(gap_bytes(), fast_bytes_) - fast_bytes_;
    return static_cast<uint>(bytes / k_block_bytes * k_block_records);
}

ContactRoom ContactRoom::grown(const ContactDemand& demand) const {
    ContactRoom larger = *this;
    larger.fit(demand);
    const bool beside = constraints_ == ConstraintPlace::BesideContacts;
    if (beside) larger.constraints_ = ConstraintPlace::OverNewContacts; // longer contacts may make the gap shorter
    return larger;
}

bool ContactRoom::has_places_of(const ContactRoom& other) const {
    return demand_.pairs == other.demand_.pairs && demand_.keeps_old == other.demand_.keeps_old &&
           starts_with_old_ == other.starts_with_old_ && constraints_ == other.constraints_ && bytes() == other.bytes();
}

void ContactRoom::swap() {
    starts_with_old_ = !starts_with_old_;
    if (constraints_ == ConstraintPlace::OverOldContacts) constraints_ = ConstraintPlace::OverNewContacts;
}

} // namespace talus::engine
