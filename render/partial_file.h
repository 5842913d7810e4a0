// SPDX-License-Identifier: MIT
// A file that appears under its name only once it is complete.
#pragma once

#include <filesystem>

namespace talus::render {

/// Names a temporary file beside the target; it is removed again unless `commit` puts it in the target's place.
class PartialFile {
public:
    explicit PartialFile(std::filesystem::path target);
    ~PartialFile();
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    const std::filesystem::path& target() const noexcept { return target_; }
    const std::filesystem::path& temporary() const noexcept { return temporary_; }
    /// Throws Error where the target cannot be replaced.
    void commit();

private:
    std::filesystem::path target_, temporary_;
    bool committed_ = false;
};

} // namespace talus::render
