// SPDX-License-Identifier: MIT
// Picture k of the video shows the first state at or after k divided by the frame rate.
#include "cli/frame_outputs.h"

#include <algorithm>
#include <cmath>

#include "cli/output_file.h"
#include "render/picture.h"

namespace talus::cli {
namespace {

RecordingHeader header_of(const TimedRun& run) {
    RecordingHeader header;
    header.scene = run.scene().name;
    header.dt = run.world().settings().dt;
    header.bodies.reserve(run.scene().bodies.size());
    for (const scenes::NamedBody& body : run.scene().bodies)
        header.bodies.push_back({body.name, body.definition.kind, body.definition.shape});
    return header;
}

} // namespace

FrameOutputs::FrameOutputs(const OutputOptions& output_options, const TimedRun& run)
    : options(output_options), world(run.world()) {
    if (!options.video.empty() && (options.width % 2 != 0 || options.height % 2 != 0))
        throw Error("a video needs an even width and height; --width and --height give " +
                    std::to_string(options.width) + " × " + std::to_string(options.height));
    if (!options.image.empty()) check_replaceable_output(options.image);
    if (!options.video.empty()) check_replaceable_output(options.video);
    if (!options.recording.empty()) recording.emplace(options.recording, header_of(run));
    if (!options.image.empty() || !options.video.empty())
        renderer.emplace(world, options.width, options.height, run.scene().camera, options.overlays);
    if (!options.video.empty()) video.emplace(options.video, options.width, options.height, options.frames_per_second);
}

std::uint64_t FrameOutputs::pictures_in_software(std::uint64_t steps) const {
    if (!renderer || !renderer->draws_in_software()) return 0;
    const std::uint64_t of_video = video ? std::min(pictures_due(steps), steps + 1) : 0; // a state is drawn once
    return of_video + (options.image.empty() ? 0 : 1);
}

bool FrameOutputs::wants(std::uint64_t steps) const {
    return recording || (video && pictures_due(steps) > pictures);
}

void FrameOutputs::add(std::uint64_t steps) {
    if (recording) recording->write(world.poses());
    if (!video || pictures_due(steps) <= pictures) return;
    repeats.push(pictures_due(steps) - pictures);
    pictures = pictures_due(steps);
    renderer->submit();
    if (renderer->pending() == render::Renderer::k_most_pending) collect_picture();
}

void FrameOutputs::finish() {
    while (renderer && renderer->pending() > 0)
        collect_picture();
    if (!options.image.empty()) render::write_png(options.image, renderer->draw());
    if (video) video->finish();
    if (recording) recording->finish();
}

void FrameOutputs::collect_picture() {
    const render::Picture picture = renderer->collect();
    for (std::uint64_t i = 0; i < repeats.front(); ++i)
        video->add(picture);
    repeats.pop();
}

std::uint64_t FrameOutputs::pictures_due(std::uint64_t steps) const {
    // The small part keeps 1/60 s, as the nearest float, from falling just short of every second picture.
    const double elapsed = static_cast<double>(steps) * world.settings().dt;
    return static_cast<std::uint64_t>(std::floor(elapsed * options.frames_per_second + 1e-3)) + 1;
}

} // namespace talus::cli
