// SPDX-License-Identifier: MIT
// Files that a command writes at its end: refused at its start where that could not work.
#pragma once

#include <filesystem>
#include <string_view>

namespace talus::cli {

/// Throws Error where a file of this name cannot be written; leaves nothing behind.
void check_output(const std::filesystem::path&);

/// Also throws where there is something of that name that is not a file, such as a device or a link: for writers that
/// always rename their result into place.
void check_replaceable_output(const std::filesystem::path&);

/// Writes all or nothing; an existing file is replaced. Throws Error.
void write_output(const std::filesystem::path&, std::string_view text);

} // namespace talus::cli
