// SPDX-License-Identifier: MIT
// How kernels load and store records: 16 bytes at a time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::engine {

/// GLSL beside a `struct R` of whole 16-byte cells, of members float, uint, vec3 and vec4: a `struct RCells` of the
/// members `uvec4 cell_0`, `cell_1`, ..., with the functions `R unpack(RCells)` and `RCells pack(R)`. A buffer declared
/// as an array of RCells is read with one load a cell, where one declared as an array of R takes one a member on some
/// GPUs: three to four times as many, and kernels that wait for them.
///
/// For buffers that lie in blocks (record_blocks.h) there is a `struct RCellBlock`, and for `RCellBlock blocks[]` the
/// macros `cell_in_block(blocks, index, cell)`, an lvalue, `unpack_R(blocks, index)` and `pack_R(blocks, index,
/// record)`.
struct RecordCells {
    std::string record; // R
    std::string glsl;
};

/// Of all such records that the text declares.
std::vector<RecordCells> record_cells(std::string_view records);

/// The GLSL of those that the kernel names. With that of all records a driver spends most of its time with a small
/// kernel on reading what the kernel has no use for.
std::string cells_for(std::string_view kernel, const std::vector<RecordCells>&);

} // namespace talus::engine
