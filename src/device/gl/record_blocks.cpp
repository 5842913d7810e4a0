// SPDX-License-Identifier: MIT
// See record_blocks.h.
#include "device/gl/record_blocks.h"

#include <algorithm>
#include <cstring>

namespace talus::engine {
namespace {

/// Calls copy(place in blocks, place among records, bytes) for each cell of the records, the last of which may be cut.
template <typename Copy> void for_each_cell(std::size_t bytes, std::size_t record_bytes, const Copy& copy) {
    const std::size_t cells = record_bytes / k_cell_bytes;
    for (std::size_t at = 0; at < bytes; at += k_cell_bytes) {
        const std::size_t record = at / record_bytes, cell = at / k_cell_bytes % cells;
        const std::size_t place =
            (record / k_block_records * cells + cell) * k_block_records + record % k_block_records;
        copy(place * k_cell_bytes, at, std::min(k_cell_bytes, bytes - at));
    }
}

} // namespace

std::vector<std::byte> in_blocks(std::span<const std::byte> records, std::size_t record_bytes) {
    const std::size_t block_bytes = record_bytes * k_block_records;
    std::vector<std::byte> blocks((records.size() + block_bytes - 1) / block_bytes * block_bytes);
    for_each_cell(records.size(), record_bytes, [&](std::size_t place, std::size_t at, std::size_t bytes) {
        std::memcpy(blocks.data() + place, records.data() + at, bytes);
    });
    return blocks;
}

void out_of_blocks(std::span<const std::byte> blocks, std::size_t record_bytes, std::span<std::byte> records) {
    for_each_cell(records.size(), record_bytes, [&](std::size_t place, std::size_t at, std::size_t bytes) {
        std::memcpy(records.data() + at, blocks.data() + place, bytes);
    });
}

} // namespace talus::engine
