// SPDX-License-Identifier: MIT
// How the records of some buffers lie on the GPU: in blocks of k_block_records, cell by cell. First the first cells of
// all records of a block, then the second ones, and so on. Invocations that treat records one after the other then load
// whole lines of memory, where records of many cells would cost a line for each invocation and load.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device/device.h"

namespace talus::engine {

inline constexpr std::size_t k_cell_bytes = 16;

/// See cell_in_block in record_cells.h for the kernels' side; the host and the CPU see records one after the other.
constexpr bool lies_in_blocks(BufferId id) {
    return id == BufferId::Constraints;
}

/// Bytes of an element as the kernels declare it: a block, or a record.
constexpr std::size_t element_bytes(BufferId id) {
    return k_buffers[static_cast<std::size_t>(id)].stride * (lies_in_blocks(id) ? k_block_records : 1);
}

/// Of records one after the other. What the last block has beyond them is zero.
std::vector<std::byte> in_blocks(std::span<const std::byte> records, std::size_t record_bytes);
/// Fills `records` from whole blocks.
void out_of_blocks(std::span<const std::byte> blocks, std::size_t record_bytes, std::span<std::byte> records);

} // namespace talus::engine
