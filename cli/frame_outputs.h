// SPDX-License-Identifier: MIT
// What a run writes along the way: the recording, the video, and the picture at the end.
#pragma once

#include <cstdint>
#include <optional>
#include <queue>

#include <talus/recording.h>

#include "cli/run_options.h"
#include "cli/timed_run.h"
#include "render/renderer.h"
#include "render/video_writer.h"

namespace talus::cli {

/// The files appear when `finish` is called, all or none of what is asked for unless the disk fills up just then.
class FrameOutputs {
public:
    /// Throws Error where a file cannot be written or nothing can be drawn. The run must outlive it.
    FrameOutputs(const OutputOptions&, const TimedRun&);

    /// How many pictures a run of this many steps has drawn without a GPU; 0 where there is one.
    std::uint64_t pictures_in_software(std::uint64_t steps) const;

    /// Is there something to write after this many steps?
    bool wants(std::uint64_t steps) const;
    /// Takes the world as it is now. To be called after every number of steps that is wanted, 0 included.
    void add(std::uint64_t steps);
    void finish();

private:
    std::uint64_t pictures_due(std::uint64_t steps) const;
    void collect_picture();

    const OutputOptions& options;
    const World& world;
    std::optional<RecordingWriter> recording;
    std::optional<render::Renderer> renderer;
    std::optional<render::VideoWriter> video;
    std::uint64_t pictures = 0;        ///< of the video, so far
    std::queue<std::uint64_t> repeats; ///< how often to show each picture that is on its way
};

} // namespace talus::cli
