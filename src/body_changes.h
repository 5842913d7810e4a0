// SPDX-License-Identifier: MIT
// What the caller has changed of the bodies since the last step, on its way to the device. It costs time and bytes for
// what has changed, whatever the size of the world, and nobody waits for the steps that are on their way.
#pragma once

#include <cstdint>
#include <vector>

#include "device/device.h"

namespace talus::engine {

/// New records of one of the buffers that have one a body slot.
struct RecordChanges {
    BufferId buffer;
    std::vector<uint> slots;        ///< each once
    std::vector<std::byte> records; ///< none of Starts: the turns that these tell are forgotten
};

using BodyChanges = std::vector<RecordChanges>;

/// Takes its place behind the steps that were given to the device so far. Where one of them turns out not to fit,
/// nothing is changed: the changes behind it have to be given again with the steps behind it.
void apply_changes(Device&, const BodyChanges&);

std::uint64_t bytes_of(const BodyChanges&);

} // namespace talus::engine
