// SPDX-License-Identifier: MIT
// A compiled kernel, and what OpenGL's introspection says about it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "device/device.h"
#include "device/gl/kernel_source.h"
#include "device/gl/program_cache.h"

namespace talus::engine {

/// A storage block of a kernel; its place in GlProgram::blocks is its binding point.
struct StorageBlock {
    std::string name;
    std::optional<BufferId> buffer; ///< The one of its name; nothing: each launch says which one it stands for.
    bool written = true;
};

/// Whether the driver of the current context compiles in threads of its own, and tells when it is done.
bool compiles_side_by_side();

/// Lets the driver of the current context do so in as many threads as it likes, where it can.
void compile_side_by_side();

class GlProgram {
public:
    /// Takes the program from the cache, or gives its source (kernel_source) to the driver's compiler without waiting
    /// for it. Throws Error where a source file is missing.
    GlProgram(const std::string& path, const KernelTarget&, const ProgramCache&);
    ~GlProgram();
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;

    /// Waits for the compiler; to be called before anything of what follows. Throws Error with the driver's log, in
    /// which the lines are those of the source files; or where the records of a block have another size than in
    /// k_buffers.
    void finish(const ProgramCache&);
    bool finished() const noexcept { return !source_; }
    /// Whether to finish it means no waiting for the compiler's threads. True where the driver does not tell.
    bool is_compiled() const;

    GLuint name() const noexcept { return name_; }
    const std::vector<StorageBlock>& blocks() const noexcept { return blocks_; }
    bool uses_parameters() const noexcept { return uses_parameters_; }
    /// The buffer behind a block in this launch. Throws Error for a block that the launch binds nothing to.
    BufferId buffer(const StorageBlock&, const Launch&) const;
    void set_args(const std::array<uint, 4>&);

private:
    void begin_compiling();
    void check_compiled() const;
    void find_blocks();
    void find_parameters();
    void check_stride(GLuint block_index, const std::string& block, std::size_t bytes) const;

    std::string path_;
    std::unique_ptr<KernelSource> source_; // until the program is finished
    GLuint shader_ = 0;                    // the compiler's; 0 for a program from the cache
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
