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
    std::string name;                ///< as the writer called it
    BodyKind kind = BodyKind::Rigid; ///< as in its definition
    Shape shape;                     ///< as in its definition
};

/// What stands at the start of a recording.
struct RecordingHeader {
    std::string scene;                ///< what was recorded
    float dt = 0.0f;                  ///< s between frames
    std::vector<RecordedBody> bodies; ///< in the order of each frame's poses
};

/// Writes frame after frame; the file is complete, and appears under its name, once `finish` returns.
class TALUS_API RecordingWriter {
public:
    /// Throws Error where the file cannot be written.
    RecordingWriter(const std::filesystem::path&, const RecordingHeader&);
    ~RecordingWriter(); ///< Without `finish` the unfinished file is removed.
    /// Poses in the order of the header's bodies; throws Error on a wrong count or a full disk.
    void write(std::span<const Pose>);
    /// Completes the file and gives it its name. Throws Error on a full disk.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Reads a recording. Throws Error on a file that is not one, is damaged, or ends early, and says which.
class TALUS_API RecordingReader {
public:
    /// Reads the header; throws Error as said above.
    explicit RecordingReader(const std::filesystem::path&);
    ~RecordingReader();
    /// What the recording holds of its bodies.
    const RecordingHeader& header() const noexcept;
    /// How many frames there are; the first is the state before the first step.
    std::size_t frame_count() const noexcept;
    /// The next frame's poses; empty after the last.
    std::vector<Pose> next();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace talus
