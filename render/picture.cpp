// SPDX-License-Identifier: MIT
// Pictures to PNG files, through libpng's simplified interface.
#include "render/picture.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <png.h>

#include <talus/types.h>

#include "render/partial_file.h"

namespace talus::render {

void write_png(const std::filesystem::path& path, const Picture& picture) {
    const auto fail = [&](const char* reason) -> Error {
        return Error("cannot write the picture " + path.string() + ": " + reason);
    };
    if (picture.rgb.empty() || picture.rgb.size() != std::size_t{3} * picture.width * picture.height)
        throw fail("its pixels do not match its size");

    PartialFile file(path);
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.temporary().c_str(), "wb"), &std::fclose);
    if (!stream) throw fail(std::strerror(errno));

    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_stdio(&image, stream.get(), 0, picture.rgb.data(), 0, nullptr)) throw fail(image.message);
    // A full disk may show only when the last bytes leave.
    if (std::fclose(stream.release()) != 0) throw fail(std::strerror(errno));
    file.commit();
}

} // namespace talus::render
