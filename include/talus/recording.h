// SPDX-License-Identifier: MIT
// Recordings: every pose of every step in one compressed file. docs/recording.md describes the format.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <talus/export.h>
#include <talus/types.h>

namespace talus {

/// What a recording holds of a body that does not change.
struct RecordedBody {
    std::string name;
    BodyKind kind = BodyKind::Rigid;
    Shape shape;
};

struct RecordingHeader {
    std::string scene;
    float dt = 0.0f; ///< s between frames
    std::vector<RecordedBody> bodies;
};

/// Writes frame after frame; the file is complete, and appears under its name, once `finish` returns.
class TALUS_API RecordingWriter {
public:
    /// Throws Error where the file cannot be written.
    RecordingWriter(const std::filesystem::path&, const RecordingHeader&);
    ~RecordingWriter(); ///< Without `finish` the unfinished file is removed.
    /// Poses in the order of the header's bodies; throws Error on a wrong count or a full disk.
    void write(std::span<const Pose>);
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Reads a recording. Throws Error on a file that is not one, is damaged, or ends early, and says which.
class TALUS_API RecordingReader {
public:
    explicit RecordingReader(const std::filesystem::path&);
    ~RecordingReader();
    const RecordingHeader& header() const noexcept;
    std::size_t frame_count() const noexcept;
    /// The next frame's poses; empty after the last.
    std::vector<Pose> next();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace talus
