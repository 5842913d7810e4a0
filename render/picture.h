// SPDX-License-Identifier: MIT
// A finished picture, and its way into a PNG file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace talus::render {

/// Rows from top to bottom, three bytes a pixel (red, green, blue; sRGB).
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Writes a PNG file. Throws Error where the file cannot be written; a file of that name then stays as it was.
void write_png(const std::filesystem::path&, const Picture&);

} // namespace talus::render
