// SPDX-License-Identifier: MIT
// A compiled kernel, and what OpenGL's introspection says about it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "device/device.h"

namespace talus::engine {

/// A storage block of a kernel; its place in GlProgram::blocks is its binding point.
struct StorageBlock {
    std::string name;
    std::optional<BufferId> buffer; ///< Nothing for a parameterised block: each launch says which buffer it stands for.
    bool written = true;
};

class GlProgram {
public:
    /// Compiles and links. Throws Error with the driver's log, in which the lines are those of the source files; or
    /// where the records of a block have another size than in k_buffers.
    explicit GlProgram(const std::string& path);
    ~GlProgram();
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;

    GLuint name() const noexcept { return name_; }
    const std::vector<StorageBlock>& blocks() const noexcept { return blocks_; }
    bool uses_parameters() const noexcept { return uses_parameters_; }
    /// The buffer behind a block in this launch. Throws Error for a block that the launch binds nothing to.
    BufferId buffer(const StorageBlock&, const Launch&) const;
    void set_args(const std::array<uint, 4>&);

private:
    void find_blocks(const std::string& source);
    void check_stride(GLuint block_index, const BufferInfo&) const;

    std::string path_;
    GLuint name_ = 0;
    std::vector<StorageBlock> blocks_;
    bool uses_parameters_ = false;
    GLint args_location_ = -1;
    std::array<uint, 4> args_{}; // as they are on the GPU; new programs have zeros
};

/// Where the block `Parameters` of every kernel is bound.
inline constexpr GLuint k_parameters_binding = 0;

/// Most storage blocks of a kernel: what every driver of the portable floor has.
inline constexpr std::size_t k_max_storage_blocks = 16;

} // namespace talus::engine
