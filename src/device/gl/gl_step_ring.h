// SPDX-License-Identifier: MIT
// What leaves the GPU at the end of each step, without anyone waiting for it: counters, poses and stage times, for the
// last k_ring_size steps.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "device/device.h"
#include "device/gl/gl_objects.h"

namespace talus::engine {

class StepRing {
public:
    explicit StepRing(bool profile);
    ~StepRing();
    StepRing(const StepRing&) = delete;
    StepRing& operator=(const StepRing&) = delete;

    void begin_stage(Stage);
    /// Copies out of the two buffers, which all kernels so far must be visible in. Waits only if the ring is full.
    struct Source {
        GLuint buffer;
        std::size_t bytes; ///< from its start; 0: nothing leaves
    };
    Ticket end_step(GLuint counters, Source poses, Source reports);
    bool finished(Ticket);
    void wait(Ticket);
    std::span<const uint> counters(Ticket);
    std::span<const BodyPose> poses(Ticket);
    /// As many as the step made, at most as many as left.
    std::span<const ContactReport> reports(Ticket);
    std::span<const double> stage_ms(Ticket);
    std::size_t memory_bytes() const noexcept;

private:
    struct Slot {
        GlFence fence;
        GlBuffer poses, reports;
        std::size_t pose_count = 0, report_room = 0;
        std::vector<Stage> stages;   // begun in the step, in order
        std::vector<GLuint> queries; // a time at the start of each of them, and one at the end of the last
        std::vector<double> stage_ms;
        bool collected = true; // stage_ms is up to date
    };

    /// The slot that the step under way will fill.
    Slot& open_slot();
    Slot& slot(Ticket);
    Slot& finished_slot(Ticket);
    void mark_time(Slot&, std::size_t index);
    void collect_times(Slot&);

    bool profile_;
    bool open_ = false; // the step under way has taken its slot
    Ticket next_ = 0;
    GlBuffer counters_;
    std::array<Slot, k_ring_size> slots_;
};

} // namespace talus::engine
