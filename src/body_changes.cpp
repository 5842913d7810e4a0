// SPDX-License-Identifier: MIT
// Changes go through one buffer, part by part, and a kernel puts them in their places: a copy for each of many
// scattered slots would cost more calls than bytes, and could not look at whether the step before has fitted.
#include "body_changes.h"

#include <algorithm>
#include <bit>

#include "narrow_phase/narrow_phase.h"
#include "primitives/primitives.h"

namespace talus::engine {
namespace {

// The largest part; many bodies take several.
constexpr std::size_t k_part_bytes = std::size_t{1} << 18;

void reserve_part(Device& device, std::size_t bytes) {
    if (device.size(BufferId::Changes) < bytes) device.grow(BufferId::Changes, std::bit_ceil(bytes));
}

} // namespace

void apply_changes(Device& device, const BodyChanges& changes) {
    for (const RecordChanges& change : changes) {
        const bool forgets = change.buffer == BufferId::Starts;
        const std::size_t stride = forgets ? 0 : k_buffers[static_cast<std::size_t>(change.buffer)].stride;
        const std::size_t most = k_part_bytes / (sizeof(uint) + stride);
        for (std::size_t first = 0; first < change.slots.size(); first += most) {
            const std::size_t count = std::min(most, change.slots.size() - first);
            reserve_part(device, count * (sizeof(uint) + stride));
            device.write(BufferId::Changes, 0, std::as_bytes(std::span(change.slots).subspan(first, count)));
            device.write(BufferId::Changes, count * sizeof(uint),
                         std::span(change.records).subspan(first * stride, count * stride));
            if (forgets)
                forget_changed_turns(device, static_cast<uint>(count));
            else
                scatter_changed_records(device, change.buffer, static_cast<uint>(count));
        }
    }
}

std::uint64_t bytes_of(const BodyChanges& changes) {
    std::uint64_t bytes = 0;
    for (const RecordChanges& change : changes)
        bytes += change.slots.size() * sizeof(uint) + change.records.size();
    return bytes;
}

} // namespace talus::engine
