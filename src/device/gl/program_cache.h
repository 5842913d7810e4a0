// SPDX-License-Identifier: MIT
// Linked programs on disk, so that only the first world on a machine waits for the driver's compiler.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <epoxy/gl.h>

namespace talus::engine {

/// A file for each kernel and driver, in the folder talus below the user's cache folder ($XDG_CACHE_HOME, or else
/// ~/.cache). A file that is broken, or was made by another driver or from another source, counts as none and is
/// replaced. Nothing here is an error: what cannot be read or written leaves the compiler to do its work.
class ProgramCache {
public:
    /// For the context that is current. Neither reads nor writes unless `wanted`, where the environment variable
    /// TALUS_PROGRAM_CACHE is 0, where there is no cache folder, or where the driver does not give programs away.
    explicit ProgramCache(bool wanted);

    bool keeps() const noexcept { return !folder_.empty(); }

    /// A linked program with this source, in its initial state; 0 where there is none.
    GLuint load(const std::string& kernel, std::string_view source) const;
    void store(const std::string& kernel, std::string_view source, GLuint linked_program) const;

private:
    std::filesystem::path file_of(const std::string& kernel) const;

    std::filesystem::path folder_; ///< empty: no cache
    std::string driver_;           ///< all by which drivers differ
    std::vector<GLint> formats_;   ///< that the driver reads
};

} // namespace talus::engine
