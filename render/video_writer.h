// SPDX-License-Identifier: MIT
// Pictures to a video file (H.264 in MP4), through the program ffmpeg.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "render/picture.h"

namespace talus::render {

/// Takes picture after picture; the file is complete, and appears under its name, once `finish` returns.
class VideoWriter {
public:
    /// Width and height must be even, as the encoder asks for. Throws Error where ffmpeg cannot be started or the
    /// folder does not exist.
    VideoWriter(const std::filesystem::path&, std::uint32_t width, std::uint32_t height, double frames_per_second);
    ~VideoWriter(); ///< Without `finish` ffmpeg is stopped and the unfinished file removed.
    /// Throws Error on a picture of another size, and with ffmpeg's own words where ffmpeg gives up.
    void add(const Picture&);
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace talus::render
