// SPDX-License-Identifier: MIT
// The text of the compute shaders: found, put together with what they include, and traced back from the driver's log.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace talus::engine {

struct ShaderFile {
    std::string_view path; ///< below src/: "broad_phase/update_aabbs.comp.glsl"
    std::string_view text;
};

/// What a kernel may rely on where it runs; each is a constant at its head.
struct KernelTarget {
    /// k_waits_freely: invocations of a work group run side by side, so that they may wait for each other without a
    /// barrier, and a group may have 44 KB of shared memory.
    bool waits_freely = false;
    unsigned in_step = 64; ///< k_in_step: so many invocations next to each other run in step, or a divisor of it
};

/// Every shader file as the build embedded it, sorted by path. cmake/embed_kernels.cmake makes the definition.
std::span<const ShaderFile> embedded_files();

/// Every embedded kernel as Kernel::path names it: below src/, without .comp.glsl.
std::vector<std::string> kernel_paths();

/// One complete compute shader, and where each of its lines comes from.
struct KernelSource {
    struct Origin {
        std::size_t file; ///< index in `files`
        std::size_t line; ///< from 1
    };
    std::string text;
    std::vector<std::string> files;
    std::vector<Origin> lines;
};

/// Throws Error where TALUS_KERNEL_PATH (see kernel_source) is set and can change nothing: to be called once before
/// kernels are made, since a wrong folder would otherwise pass unnoticed.
void check_kernel_folder();

/// Puts the kernel, all that it includes and the prelude of all kernels together. Files below the folder that the
/// environment variable TALUS_KERNEL_PATH names replace the embedded ones of the same path, so that a kernel can be
/// changed without building the library. Throws Error for a file that is in neither.
KernelSource kernel_source(std::string_view path, const KernelTarget& = {});

/// A compiler's log with the source files' names and lines in place of the lines of the whole text.
std::string trace_log(std::string_view log, const KernelSource&);

} // namespace talus::engine
