// SPDX-License-Identifier: MIT
// Draws a session's world in the window's context, and takes pictures of it without the panels around.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "render/bodies_to_draw.h"
#include "render/canvas.h"
#include "render/painter.h"
#include "render/video_writer.h"
#include "viewer/session.h"

namespace talus::viewer {

/// A part of the window, from its left side on and over its whole height (pixels).
struct Region {
    std::uint32_t left = 0, width = 0, height = 0;
};

class Display {
public:
    render::Overlays overlays;

    /// A picture of this size; on a GPU straight from the solver's buffers. `more` is drawn besides. `content_scale`:
    /// pixels for one of a usual screen.
    void draw(const Session&, const scenes::Camera&, std::uint32_t width, std::uint32_t height, float content_scale,
              std::span<const render::Line> more = {});
    /// Puts what was drawn into a part of the window's framebuffer.
    void show(const Region&);
    /// Edge length of the usual body that can move (m).
    float typical_size() const noexcept { return bodies ? bodies->typical_size() : 1.0f; }

    /// What was drawn last, as a PNG file. Throws Error where it cannot be written.
    void save_picture(const std::filesystem::path&);

    /// Begins a video. Throws Error where ffmpeg cannot be had, or nothing was drawn yet.
    void start_video(const std::filesystem::path&);
    bool is_recording() const noexcept { return video != nullptr; }
    /// What was drawn last becomes the video's next picture, which is shown for k_frame_time. Throws Error where ffmpeg
    /// gives up; the video has ended then.
    void record();
    static constexpr std::chrono::duration<double> k_frame_time{1.0 / 30.0};
    /// The video's file appears. Throws Error, as ffmpeg may.
    void finish_video();

private:
    void fit_canvas(std::uint32_t width, std::uint32_t height);
    void collect();

    render::Painter painter;
    std::optional<render::Canvas> canvas;
    std::optional<render::BodiesToDraw> bodies;
    std::uint64_t generation = 0; ///< of the session's bodies that `bodies` lists
    std::uint32_t canvas_width = 0, canvas_height = 0;
    std::unique_ptr<render::VideoWriter> video;
};

} // namespace talus::viewer
